#include "waypoint_solver.hpp"

#include <algorithm>

namespace counterflex {

WaypointSolver::WaypointSolver(const Job& job, const Model& model, Configuration start)
    : job_(job), model_(model), start_(std::move(start)) {
  if (job.starts != nullptr) batch_.emplace(job.starts->of(model, job.forces.at_platform()));
}

// Begins beside `p` where others have been answered since.
PathSolver& WaypointSolver::one_by_one(const Vector3& p) {
  const Configuration* near = batch_ && (strayed_ || !one_by_one_) ? batch_->nominal_near(p) : nullptr;
  strayed_ = false;
  if (!one_by_one_)
    one_by_one_.emplace(job_, model_, near != nullptr ? *near : start_);
  else if (near != nullptr)
    one_by_one_->stand_at(*near);
  return *one_by_one_;
}

void WaypointSolver::begin_anew() {
  if (one_by_one_) one_by_one_->stand_at(start_);
  strayed_ = true;
}

void WaypointSolver::solve_in_batch(BatchQuestion question, const Stage& stage) {
  answers_.assign(requests_.size(), {});
  if (batch_) batch_->solve(question, stage, requests_, answers_);
}

void WaypointSolver::wanted(std::span<const Vector3> p_MT, std::span<WantedPose> out) {
  nominals_.assign(p_MT.size(), {});
  if (batch_) batch_->nominal_tips(p_MT, nominals_);
  for (std::size_t i = 0; i < p_MT.size(); ++i) {
    if (nominals_[i].solved)
      out[i] = {Status::converged, nominals_[i].X_MT};
    else
      out[i].X_MT = one_by_one(p_MT[i]).wanted(p_MT[i], out[i].status);
    strayed_ = strayed_ || nominals_[i].solved;
  }
}

void WaypointSolver::targets(std::span<const TargetRequest> requests, std::span<TargetSolution> out) {
  requests_.clear();
  for (const TargetRequest& request : requests) requests_.push_back({request.p_MT, request.load.F});
  const bool direct = job_.options.method == Method::direct;
  if (direct)
    solve_in_batch(BatchQuestion::target, {});
  else
    answers_.assign(requests.size(), {});
  for (std::size_t i = 0; i < requests.size(); ++i) {
    if (answers_[i].solved)
      out[i] = {Status::converged, answers_[i].command, answers_[i].iterations};
    else
      out[i] = one_by_one(requests[i].p_MT).target(requests[i].p_MT, requests[i].load);
    strayed_ = strayed_ || answers_[i].solved;
  }
}

void WaypointSolver::actuals(std::span<const ActualRequest> requests, std::span<ActualSolution> out) {
  // In runs of what has one stage.
  for (std::size_t begin = 0, end = 0; begin < requests.size(); begin = end) {
    while (end < requests.size() && requests[end].stage == requests[begin].stage) ++end;
    solve_actuals(requests.subspan(begin, end - begin), out.subspan(begin, end - begin));
  }
}

void WaypointSolver::solve_actuals(std::span<const ActualRequest> requests, std::span<ActualSolution> out) {
  requests_.clear();
  for (const ActualRequest& request : requests)
    requests_.push_back({request.target, request.stage.load * request.load.F});
  solve_in_batch(BatchQuestion::forward, requests.front().stage);
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const ActualRequest& request = requests[i];
    BatchAnswer& answer = answers_[i];
    if (answer.solved)
      out[i] = {Status::converged, answer.X_MT, answer.iterations, std::move(answer.rho)};
    else
      out[i] = one_by_one(request.target).actual(request.target, request.load, request.stage, request.start);
    strayed_ = strayed_ || answer.solved;
  }
}

}  // namespace counterflex
