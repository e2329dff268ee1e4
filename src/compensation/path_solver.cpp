#include "path_solver.hpp"

#include <algorithm>

#include "counterflex/statics/linear.hpp"
#include "counterflex/statics/nested.hpp"

namespace counterflex {
namespace {

constexpr int most_outer_iterations = 60;
constexpr double outer_tolerance = 1e-11;

bool controls_only_positions(const Mechanism& mechanism) {
  return std::all_of(mechanism.controlled.begin(), mechanism.controlled.end(),
                     [](Component c) { return c <= Component::z; });
}

void copy_nominal(const SeriesState& nominal, SeriesState& state) {
  state.x_nominal = nominal.x;
  for (std::size_t g = 0; g < state.groups.size(); ++g)
    for (std::size_t b = 0; b < state.groups[g].branches.size(); ++b)
      copy_nominal(nominal.groups[g].branches[b], state.groups[g].branches[b]);
}

// A loaded neighbour as the start for a new nominal configuration.
Configuration neighbour(const Configuration& loaded, const Configuration& nominal) {
  Configuration start = loaded;
  for (std::size_t i = 0; i < start.chains.size(); ++i) copy_nominal(nominal.chains[i], start.chains[i]);
  return start;
}

}  // namespace

Load load_at(const Job& job, std::size_t segment, double fraction) {
  return {job.forces.at(segment, fraction), job.forces.at_platform()};
}

PathSolver::PathSolver(const Job& job, const Model& model, Configuration start)
    : job_(job),
      model_(model),
      R_MT_home_(tip(model.mechanism, model.home).R),
      work_(model.mechanism),
      nominal_(model, std::move(start)),
      writes_all_controlled_(controls_only_positions(model.mechanism)) {}

void PathSolver::stand_at(const Configuration& nominal) {
  nominal_ = NominalPath(model_, nominal);
  loaded_.reset();
}

PathSolver& ToolSolver::of(const Model& model, const Configuration& start) {
  if (!is_of(model)) solver_.emplace(job_, model, start);
  return *solver_;
}

Status PathSolver::go_to(const Vector3& p_MT) {
  return nominal_.go_to({R_MT_home_, p_MT});
}

Status PathSolver::travel_status() const {
  const Mechanism& mechanism = model_.mechanism;
  return within_travel(mechanism, actuator_values(mechanism, nominal())) ? Status::converged
                                                                         : Status::outside_travel;
}

Pose PathSolver::wanted(const Vector3& p_MT, Status& status) {
  status = go_to(p_MT);
  return tip(model_.mechanism, nominal());
}

Vector3 PathSolver::tip_of(const Configuration& configuration) const {
  return tip(model_.mechanism, configuration).p;
}

// A warm start may fail where a cold one does not; the continuation decides.
Equilibrium PathSolver::forward(const Load& load, const Stage& stage, Start from) {
  const bool warm = from == Start::neighbour && loaded_ && everything_acts(stage);
  if (warm) {
    Configuration start = neighbour(*loaded_, nominal());
    set_actuator_values(model_.mechanism, actuator_values(model_.mechanism, nominal()), start);
    Equilibrium refined = refine_forward(model_, start, load, stage, work_);
    if (refined.status == Status::converged) {
      loaded_ = refined.configuration;
      return refined;
    }
  }
  Equilibrium solved = solve_forward(model_, nominal(), load, stage, work_);
  if (solved.status == Status::converged && everything_acts(stage)) loaded_ = solved.configuration;
  return solved;
}

ActualSolution PathSolver::actual(const Vector3& target, const Load& load, const Stage& stage, Start start) {
  ActualSolution result;
  result.status = go_to(target);
  if (result.status != Status::converged) return result;
  const Equilibrium solved = forward(load, stage, start);
  result.status = solved.status;
  result.iterations = solved.iterations;
  result.X_MT = tip(model_.mechanism, solved.configuration);
  result.rho = actuator_values(model_.mechanism, nominal());
  return result;
}

// Where the machine controls an orientation that the program does not state, only positions can be written:
// (23) on them.
TargetSolution PathSolver::by_outer_iteration(const Vector3& p_MT, const Load& load) {
  TargetSolution result;
  result.target = p_MT;
  for (int i = 0; i < most_outer_iterations; ++i) {
    const ActualSolution reached = actual(result.target, load, {});
    result.status = reached.status;
    result.iterations += reached.iterations;
    if (reached.status != Status::converged) return result;
    const Vector3 miss = reached.X_MT.p - p_MT;
    if (miss.norm() < outer_tolerance) {
      result.status = travel_status();
      return result;
    }
    result.target -= miss;
  }
  result.status = Status::not_converged;
  return result;
}

TargetSolution PathSolver::by_method(const Vector3& p_MT, const Load& load) {
  const Pose X_MT{tip(model_.mechanism, nominal()).R, p_MT};
  Equilibrium solved;
  if (job_.options.method == Method::nested) {
    solved = solve_target_nested(model_, nominal(), X_MT, load, {}, work_);
  } else {
    if (loaded_) solved = refine_target(model_, neighbour(*loaded_, nominal()), X_MT, load, {}, work_);
    if (solved.status != Status::converged) solved = solve_target(model_, nominal(), X_MT, load, {}, work_);
  }
  TargetSolution result{solved.status, p_MT, solved.iterations};
  if (solved.status != Status::converged) return result;
  if (job_.options.method == Method::direct) loaded_ = solved.configuration;
  const Eigen::VectorXd rho = actuator_values(model_.mechanism, solved.configuration);
  const NominalResult commanded = nominal_forward(model_, nominal(), rho);
  result.status = commanded.status;
  result.target = tip(model_.mechanism, commanded.configuration).p;
  for (int c = 0; c < 3; ++c)  // what is not controlled is not written
    if (std::count(model_.mechanism.controlled.begin(), model_.mechanism.controlled.end(), Component{c}) == 0)
      result.target[c] = p_MT[c];
  if (result.status == Status::converged && !within_travel(model_.mechanism, rho))
    result.status = Status::outside_travel;
  return result;
}

TargetSolution PathSolver::by_linear_theory(const Vector3& p_MT, const Load& load) {
  const LinearResult linear = linear_deviation(model_, nominal(), load, {}, work_);
  if (linear.status != Status::converged) return {linear.status, p_MT, 1};
  const Pose X_MT{tip(model_.mechanism, nominal()).R, p_MT};
  TargetSolution result{Status::converged, linear_target(model_, X_MT, linear).p, 1};
  result.status = go_to(result.target);
  if (result.status == Status::converged) result.status = travel_status();
  return result;
}

TargetSolution PathSolver::target(const Vector3& p_MT, const Load& load) {
  TargetSolution result;
  result.status = go_to(p_MT);
  if (result.status != Status::converged) return result;
  if (job_.options.method == Method::linear) return by_linear_theory(p_MT, load);
  return writes_all_controlled_ ? by_method(p_MT, load) : by_outer_iteration(p_MT, load);
}

}  // namespace counterflex
