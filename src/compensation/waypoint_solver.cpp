#include "waypoint_solver.hpp"

#include <algorithm>

namespace counterflex {
bool has_lanes_for_targets(const Job& job) {
  return job.lanes != nullptr && job.options.method == Method::direct;
}

WaypointSolver::WaypointSolver(const Job& job, const Model& model, Configuration start)
    : job_(job), model_(model), start_(std::move(start)) {
  if (job.lanes != nullptr) lanes_.emplace(job.lanes->of(model, job.forces.at_platform()));
}

// Begins beside `p` where others have been answered since.
PathSolver& WaypointSolver::one_by_one(const Vector3& p) {
  const Configuration* near = lanes_ && (strayed_ || !one_by_one_) ? lanes_->nominal_near(p) : nullptr;
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

void WaypointSolver::solve_in_lanes(LaneQuestion question, const Stage& stage) {
  answers_.resize(requests_.size());
  lanes_->solve(question, stage, requests_, answers_);
}

void WaypointSolver::wanted(std::span<const Vector3> p_MT, std::span<WantedPose> out) {
  for (std::size_t i = 0; i < p_MT.size(); ++i) {
    const bool known = lanes_ && lanes_->nominal_tip(p_MT[i], out[i].X_MT);
    if (known)
      out[i].status = Status::converged;
    else
      out[i].X_MT = one_by_one(p_MT[i]).wanted(p_MT[i], out[i].status);
    strayed_ = strayed_ || known;
  }
}

void WaypointSolver::targets(std::span<const TargetRequest> requests, std::span<TargetSolution> out) {
  targets(requests, {}, nullptr, out, {});
}

void WaypointSolver::targets(std::span<const TargetRequest> requests, std::span<const ThroughRequest> through,
                             const ForeseenCommand& foreseen, std::span<TargetSolution> out,
                             std::span<KnownPlace> known) {
  const bool in_lanes = has_lanes_for_targets(job_);
  std::fill(known.begin(), known.end(), KnownPlace{});
  if (in_lanes) targets_in_lanes(requests, through, foreseen, known);
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const bool solved = in_lanes && answers_[i].solved;
    if (solved)
      out[i] = {Status::converged, answers_[i].command, answers_[i].iterations};
    else
      out[i] = one_by_one(requests[i].p_MT).target(requests[i].p_MT, requests[i].load);
    strayed_ = strayed_ || solved;
  }
}

// What is asked through by itself, so that batches are full of what is asked alike.
void WaypointSolver::targets_in_lanes(std::span<const TargetRequest> requests,
                                      std::span<const ThroughRequest> through,
                                      const ForeseenCommand& foreseen, std::span<KnownPlace> known) {
  requests_.clear();
  std::size_t next = 0;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    if (next < through.size() && through[next].target == i)
      ++next;
    else
      requests_.push_back({requests[i].p_MT, requests[i].load.F});
  }
  solve_in_lanes(LaneQuestion::target, {});
  if (through.empty()) return;
  through_in_lanes(requests, through, foreseen, known);
  // Both in the order of requests again, from behind: nothing is overwritten before it is moved.
  std::size_t other = answers_.size();
  answers_.resize(requests.size());
  for (std::size_t i = requests.size(); i-- > 0;)
    answers_[i] = next > 0 && through[next - 1].target == i ? through_answers_[--next].target
                                                            : LaneAnswer(answers_[--other]);
}

void WaypointSolver::through_in_lanes(std::span<const TargetRequest> requests,
                                      std::span<const ThroughRequest> through,
                                      const ForeseenCommand& foreseen, std::span<KnownPlace> known) {
  through_requests_.clear();
  originals_.clear();
  for (const ThroughRequest& one : through) {
    through_requests_.push_back({requests[one.target].p_MT, requests[one.target].load.F});
    originals_.push_back(one.original);
  }
  through_answers_.resize(through.size());
  lanes_->solve_through(
      through_requests_, originals_,
      [&](std::size_t i, const Vector3& target) { return known[i].after.command = foreseen(i, target); },
      through_answers_);
  const auto know = [](const LaneAnswer& answer, KnownTip& tip) {
    tip.X_MT = answer.X_MT;
    tip.iterations = answer.iterations;
    tip.known = answer.solved;
  };
  for (std::size_t i = 0; i < through.size(); ++i) {
    known[i].load = requests[through[i].target].load;
    known[i].before.command = originals_[i];
    know(through_answers_[i].before, known[i].before);
    know(through_answers_[i].after, known[i].after);
  }
}

void WaypointSolver::actuals(std::span<const ActualRequest> requests, std::span<ActualSolution> out) {
  // In runs of what has one stage.
  for (std::size_t begin = 0, end = 0; begin < requests.size(); begin = end) {
    while (end < requests.size() && requests[end].stage == requests[begin].stage) ++end;
    actuals_in_lanes(requests.subspan(begin, end - begin), out.subspan(begin, end - begin));
  }
}

void WaypointSolver::actuals_in_lanes(std::span<const ActualRequest> requests,
                                      std::span<ActualSolution> out) {
  if (lanes_) {
    requests_.clear();
    for (const ActualRequest& request : requests)
      if (request.known == nullptr)
        requests_.push_back({request.target, request.stage.load * request.load.F});
    solve_in_lanes(LaneQuestion::forward, requests.front().stage);
  }
  std::size_t next = 0;  // in answers_
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const ActualRequest& request = requests[i];
    if (const KnownTip* known = request.known) {
      out[i] = {Status::converged, known->X_MT, known->iterations, true};
      strayed_ = true;
      continue;
    }
    const LaneAnswer* answer = lanes_ ? &answers_[next++] : nullptr;
    if (answer != nullptr && answer->solved) {
      out[i] = {Status::converged, answer->X_MT, answer->iterations, true};
      strayed_ = true;
      continue;
    }
    PathSolver& solver = one_by_one(request.target);
    out[i] = solver.actual(request.target, request.load, request.stage, request.start);
    out[i].in_travel = solver.in_travel();
  }
}

}  // namespace counterflex
