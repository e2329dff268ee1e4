#include "counterflex/statics/pose_solver.hpp"

#include <utility>
#include <vector>

#include "counterflex/geometry/pose.hpp"
#include "counterflex/statics/tip_stiffness.hpp"

namespace counterflex {
namespace {

constexpr Stage whole_stage{};

/// A pose, solved: where the perfect machine is, and the real one.
struct PoseState {
  Status status = Status::not_converged;
  Configuration loaded;
};

/// The nominal configuration of a pose, if it is in travel.
NominalResult nominal_at(const Model& model, const Configuration& from, const Pose& X_MT) {
  constexpr double near = 1e-9;  // m and rad; on the border of travel a rounded value may be outside
  NominalResult nominal = follow(model, from, X_MT);
  if (nominal.status != Status::converged) return nominal;
  if ((tip(model.mechanism, nominal.configuration).p - X_MT.p).norm() > near)
    nominal.status = Status::unreachable;
  const auto axis = tightest_axis(model.mechanism, actuator_values(model.mechanism, nominal.configuration));
  if (axis && axis->margin < -near) nominal.status = Status::outside_travel;
  return nominal;
}

/// From home, as `analyze_pose` solves it.
PoseState solve_from_home(const Model& model, const Pose& X_MT, const Load& load, StaticsWork& work) {
  const NominalResult nominal = nominal_at(model, model.home, X_MT);
  if (nominal.status != Status::converged) return {nominal.status, {}};
  Equilibrium loaded = solve_forward(model, nominal.configuration, load, whole_stage, work);
  if (loaded.status == Status::converged && !load.F.isZero(0) &&
      !is_reached_by_load_alone(model, nominal.configuration, load, whole_stage, loaded, work))
    loaded.status = Status::unstable;
  return {loaded.status, std::move(loaded.configuration)};
}

/// The state whose tip the kernel has found, from the nominal configuration of its cell. Another status than
/// `converged`: solve from home.
PoseState solve_from_cell(const Model& model, const Configuration& near, const Pose& X_MT, const Load& load,
                          const Pose& found, StaticsWork& work) {
  const NominalResult nominal = nominal_at(model, near, X_MT);
  if (nominal.status != Status::converged) return {nominal.status, {}};
  Equilibrium loaded = equilibrium_at(model, nominal.configuration, load, whole_stage, found, work);
  return {loaded.status, std::move(loaded.configuration)};
}

}  // namespace

struct PoseSolver::Impl {
  const Model& model;
  Matrix3 R_home;
  BatchSolver kernel;
  StaticsWork work;
  std::vector<BatchRequest> requests{};
  std::vector<BatchAnswer> answers{};

  Impl(const Model& of, const StartTable& table)
      : model(of), R_home(tip(of.mechanism, of.home).R), kernel(table), work(of.mechanism) {}

  void solve(std::span<const CommandedPose> poses) {
    requests.clear();
    for (const CommandedPose& pose : poses) requests.push_back({pose.at, pose.F});
    answers.assign(poses.size(), {});
    kernel.solve(BatchQuestion::forward, whole_stage, requests, answers);
  }

  PoseState state(const CommandedPose& pose, const BatchAnswer& answer) {
    const Pose X_MT{exp_so3(pose.at.turn) * R_home, pose.at.p};
    const Load load{pose.F};
    PoseState state;
    if (answer.solved)
      if (const Configuration* near = kernel.nominal_near(pose.at))
        state = solve_from_cell(model, *near, X_MT, load, answer.X_MT, work);
    if (state.status != Status::converged) state = solve_from_home(model, X_MT, load, work);
    return state;
  }
};

PoseSolver::PoseSolver(const Model& model, const StartTable& table)
    : impl_(std::make_unique<Impl>(model, table)) {}
PoseSolver::~PoseSolver() = default;

void PoseSolver::tips(std::span<const CommandedPose> poses, std::span<LoadedTip> answers) {
  impl_->solve(poses);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const BatchAnswer& answer = impl_->answers[i];
    if (answer.solved) {
      answers[i] = {Status::converged, answer.X_MT};
      continue;
    }
    const PoseState state = impl_->state(poses[i], answer);
    answers[i].status = state.status;
    if (state.status == Status::converged) answers[i].X_MT = tip(impl_->model.mechanism, state.loaded);
  }
}

void PoseSolver::compliances(std::span<const CommandedPose> poses, std::span<LoadedCompliance> answers) {
  impl_->solve(poses);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const PoseState state = impl_->state(poses[i], impl_->answers[i]);
    answers[i].status = state.status;
    if (state.status != Status::converged) continue;
    const auto C = compliance_at_tip(impl_->model, state.loaded, {poses[i].F}, whole_stage, impl_->work);
    answers[i].status = C ? Status::converged : Status::singular;
    if (C) answers[i].C = *C;
  }
}

}  // namespace counterflex
