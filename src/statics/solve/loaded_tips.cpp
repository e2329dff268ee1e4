#include "counterflex/statics/loaded_tips.hpp"

#include "counterflex/geometry/pose.hpp"
#include "counterflex/statics/tip_stiffness.hpp"
#include "statics/solve/start_table.hpp"

namespace counterflex {
namespace {

constexpr Stage whole_stage{};

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
Equilibrium solve_from_home(const Model& model, const Pose& X_MT, const Load& load, StaticsWork& work) {
  const NominalResult nominal = nominal_at(model, model.home, X_MT);
  if (nominal.status != Status::converged) return {nominal.status};
  Equilibrium loaded = solve_forward(model, nominal.configuration, load, whole_stage, work);
  if (loaded.status == Status::converged && !load.F.isZero(0) &&
      !is_reached_by_load_alone(model, nominal.configuration, load, whole_stage, loaded, work))
    loaded.status = Status::unstable;
  return loaded;
}

/// The state whose tip the kernel has found, from the nominal configuration of its cell. Another status than
/// `converged`: solve from home.
Equilibrium solve_from_cell(const Model& model, const Configuration& near, const Pose& X_MT, const Load& load,
                            const Pose& found, StaticsWork& work) {
  const NominalResult nominal = nominal_at(model, near, X_MT);
  if (nominal.status != Status::converged) return {nominal.status};
  return equilibrium_at(model, nominal.configuration, load, whole_stage, found, work);
}

/// What solves the poses of one call.
struct PoseSolver {
  const StartTable::Impl& table;
  const Model& model;
  BatchSolver kernel;
  StaticsWork work;

  explicit PoseSolver(const StartTable& of)
      : table(of.impl()), model(table.model), kernel(of), work(model.mechanism) {}

  std::vector<BatchAnswer> solve(std::span<const BatchRequest> poses) {
    std::vector<BatchAnswer> answers(poses.size());
    kernel.solve(BatchQuestion::forward, whole_stage, poses, answers);
    return answers;
  }

  Equilibrium state(const BatchRequest& pose, const BatchAnswer& answer) {
    const Pose X_MT{exp_so3(pose.at.turn) * table.R_home, pose.at.p};
    const Load load{pose.F};
    Equilibrium state;
    if (answer.solved)
      if (const Configuration* near = kernel.nominal_near(pose.at))
        state = solve_from_cell(model, *near, X_MT, load, answer.X_MT, work);
    if (state.status != Status::converged) state = solve_from_home(model, X_MT, load, work);
    return state;
  }
};

}  // namespace

std::vector<LoadedTip> loaded_tips(const StartTable& table, std::span<const BatchRequest> poses) {
  PoseSolver solver(table);
  std::vector<LoadedTip> tips;
  const std::vector<BatchAnswer> answers = solver.solve(poses);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (answers[i].solved) {
      tips.push_back({Status::converged, answers[i].X_MT});
      continue;
    }
    const Equilibrium state = solver.state(poses[i], answers[i]);
    tips.push_back({state.status});
    if (state.status == Status::converged)
      tips.back().X_MT = tip(solver.model.mechanism, state.configuration);
  }
  return tips;
}

std::vector<LoadedCompliance> loaded_compliances(const StartTable& table,
                                                 std::span<const BatchRequest> poses) {
  PoseSolver solver(table);
  std::vector<LoadedCompliance> compliances;
  const std::vector<BatchAnswer> answers = solver.solve(poses);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Equilibrium state = solver.state(poses[i], answers[i]);
    LoadedCompliance& compliance = compliances.emplace_back();
    compliance.status = state.status;
    if (state.status != Status::converged) continue;
    const auto C =
        compliance_at_tip(solver.model, state.configuration, {poses[i].F}, whole_stage, solver.work);
    compliance.status = C ? Status::converged : Status::singular;
    if (C) compliance.C = *C;
  }
  return compliances;
}

}  // namespace counterflex
