#include <Eigen/Geometry>

#include "counterflex/statics/nominal.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "tip.hpp"

namespace counterflex {
namespace {

constexpr double closure_tolerance = 1e-12, step_tolerance = 1e-11, home_tolerance = 1e-7;
constexpr double rank_threshold = 1e-10, largest_condition = 1e6, jump_floor = 1e-4, smallest_fraction = 1e-5;
const Units kinematic_units{1.0};  // angles scaled by 1 m

// What moves in a kinematic solve.
struct Moving {
  bool actuators, platform;
};

std::vector<int> moving_columns(const WholeSystem& system, Moving moving) {
  std::vector<int> list;
  for (int i = 0; i < static_cast<int>(system.variables.size()); ++i) {
    const bool pose = i >= system.pose;
    if (pose ? moving.platform
             : !system.variables[i].elastic && (moving.actuators || system.variables[i].actuator < 0))
      list.push_back(i);
  }
  return list;
}

WholeSystem closures(const Mechanism& mechanism, const Configuration& configuration, const Units& units) {
  std::vector<SeriesWork> works;
  for (std::size_t i = 0; i < mechanism.chains.size(); ++i) {
    works.push_back(make_work(mechanism.chains[i]));
    evaluate(mechanism.chains[i], configuration.chains[i], configuration.X_MP, nominal_stage, Hessians::no, works[i]);
  }
  return assemble_whole(mechanism, works, {}, units);
}

// One linearisation: closures, and the target's rows where there is one.
struct KinematicSystem {
  std::vector<int> columns;
  Eigen::MatrixXd J;
  Eigen::VectorXd error;
  Eigen::Index variables;
};

KinematicSystem linearise(const Mechanism& mechanism, const Configuration& configuration, Moving moving,
                          const Pose* X_MT) {
  const WholeSystem whole = closures(mechanism, configuration, kinematic_units);
  KinematicSystem system{moving_columns(whole, moving), {}, whole.gap, static_cast<Eigen::Index>(whole.variables.size())};
  system.J = whole.C(Eigen::all, system.columns);
  if (!X_MT) return system;
  const Controlled target =
      to_controlled(tip_equations(mechanism, configuration.X_MP, *X_MT), mechanism, kinematic_units);
  const auto closures_count = system.J.rows(), n = target.rows.rows();
  system.J.conservativeResize(closures_count + n, Eigen::NoChange);
  system.J.bottomRows(n).setZero();
  system.J.bottomRightCorner(n, 6) = target.rows;
  system.error.conservativeResize(closures_count + n);
  system.error.tail(n) = target.rhs;
  return system;
}

Eigen::VectorXd minimum_norm(const Eigen::MatrixXd& J, const Eigen::VectorXd& rhs) {
  if (J.size() == 0) return Eigen::VectorXd::Zero(J.cols());  // nothing moves: springs alone between base and platform
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(rank_threshold);
  decomposition.compute(J);
  return decomposition.solve(rhs);
}

double step_configuration(const Mechanism& mechanism, const KinematicSystem& system, const Eigen::VectorXd& x,
                          Configuration& configuration) {
  WholeStep step;
  step.variables.setZero(system.variables);
  step.variables(system.columns) = x;
  step.wrenches.setZero(system.error.size());
  return apply(mechanism, step, kinematic_units, configuration);
}

// Damped Gauss-Newton; returns the final norm of the closures (and the target), m and rad.
double gauss_newton(const Mechanism& mechanism, Moving moving, const Pose* X_MT, Configuration& configuration) {
  KinematicSystem system = linearise(mechanism, configuration, moving, X_MT);
  double error = system.error.norm();
  for (int iteration = 0; iteration < 50; ++iteration) {
    const Eigen::VectorXd x = minimum_norm(system.J, system.error);
    const Configuration before = configuration;
    double step = 0, damping = 1;
    for (;; damping /= 2) {
      configuration = before;
      step = step_configuration(mechanism, system, damping * x, configuration);
      KinematicSystem next = linearise(mechanism, configuration, moving, X_MT);
      const double next_error = next.error.norm();
      if (next_error < error || next_error < closure_tolerance || damping < 1e-3) {
        system = std::move(next);
        error = next_error;
        break;
      }
    }
    if (error < closure_tolerance && step < step_tolerance) break;
    if (step < 1e-15 || !std::isfinite(error)) break;
  }
  return error;
}

void mark_nominal(SeriesState& state) {
  state.x_nominal = state.x;
  state.F.setZero();
  for (GroupState& group : state.groups)
    for (SeriesState& branch : group.branches) mark_nominal(branch);
}

void mark_nominal(Configuration& configuration) {
  for (SeriesState& chain : configuration.chains) mark_nominal(chain);
}

// Joints at their home values, groups where their first branch ends.
void start_at_joint_homes(const Series& series, SeriesState& state, SeriesWork& work) {
  for (const Part& part : series.parts) {
    if (part.kind == PartKind::actuator || part.kind == PartKind::passive) state.x[part.column] = part.home;
    if (part.kind != PartKind::group) continue;
    GroupState& group = state.groups[part.group];
    for (std::size_t b = 0; b < group.branches.size(); ++b)
      start_at_joint_homes(series.groups[part.group].branches[b], group.branches[b], work.groups[part.group][b]);
    group.X = work.groups[part.group][0].end;
  }
  evaluate(series, state, {}, nominal_stage, Hessians::no, work);
}

void find_home(const Machine& machine, Model& model) {
  Mechanism& mechanism = model.mechanism;
  model.home = zero_configuration(mechanism);
  for (std::size_t i = 0; i < mechanism.chains.size(); ++i) {
    SeriesWork work = make_work(mechanism.chains[i]);
    start_at_joint_homes(mechanism.chains[i], model.home.chains[i], work);
    if (i == 0) model.home.X_MP = work.end;
  }
  if (machine.home_X_MP) model.home.X_MP = *machine.home_X_MP;
  const Moving moving = machine.home_X_MP ? Moving{true, false} : Moving{false, true};
  model.home_gap = gauss_newton(mechanism, moving, nullptr, model.home);
  model.home_status = model.home_gap < home_tolerance ? Status::converged : Status::unreachable;
  mark_nominal(model.home);
}

// Mean distance of joint and spring frames from the reference point.
struct FrameDistances {
  double sum = 0;
  int count = 0;

  void add(const Series& series, const SeriesState& state, const Pose& start, const Vector3& reference) {
    Pose X = start;
    for (const Part& part : series.parts) {
      if (part.column >= 0 && part.kind != PartKind::group) {
        sum += (X.p - reference).norm();
        ++count;
      }
      if (part.kind == PartKind::fixed) X = X * part.X;
      if (part.kind == PartKind::actuator || part.kind == PartKind::passive) {
        const Vector3 motion = state.x[part.column] * part.joint.axis;
        X = X * (part.joint.kind == JointKind::prismatic ? translation(motion) : rotation(exp_so3(motion)));
      }
      if (part.kind != PartKind::group) continue;
      for (std::size_t b = 0; b < state.groups[part.group].branches.size(); ++b)
        add(series.groups[part.group].branches[b], state.groups[part.group].branches[b], X, reference);
      X = X * state.groups[part.group].X;
    }
  }
};

double stiffest(const Series& series, double length) {
  double largest = 0;
  for (const Part& part : series.parts) {
    const bool angular = part.joint.kind == JointKind::revolute;
    if (part.kind == PartKind::passive || part.kind == PartKind::compliance)
      largest = std::max(largest, part.k / (angular ? length * length : 1));
    if (part.kind == PartKind::spring)
      largest = std::max({largest, part.K.topLeftCorner<3, 3>().cwiseAbs().maxCoeff(),
                          part.K.bottomRightCorner<3, 3>().cwiseAbs().maxCoeff() / (length * length)});
  }
  for (const SeriesGroup& group : series.groups)
    for (const Series& branch : group.branches) largest = std::max(largest, stiffest(branch, length));
  return largest;
}

void relax_at_home(Series& series, const SeriesState& home) {
  for (Part& part : series.parts)
    if (part.kind == PartKind::passive && part.rest_at_home) part.rest = home.x[part.column];
  for (std::size_t g = 0; g < series.groups.size(); ++g)
    for (std::size_t b = 0; b < series.groups[g].branches.size(); ++b)
      relax_at_home(series.groups[g].branches[b], home.groups[g].branches[b]);
}

Pose between(const Pose& from, const Pose& to, double fraction) {
  return moved(from, fraction * difference(to, from));
}

// Whether an actuator step is what the Jacobian at its start predicts.
bool is_jump(const Model& model, const ActuatorJacobian& jacobian, const Eigen::VectorXd& drho, const Pose& from,
             const Pose& to) {
  const auto components = fixed_components(model.mechanism);
  if (jacobian.J.rows() != jacobian.J.cols()) return false;
  const Vector6 all = difference(to, from);
  Eigen::VectorXd dt = all(components);
  Eigen::VectorXd predicted = jacobian.J.partialPivLu().solve(dt), surplus = drho - predicted;
  for (Eigen::Index i = 0; i < drho.size(); ++i) {
    const double unit = model.mechanism.travel[i].kind == JointKind::prismatic ? model.mechanism.length : 1.0;
    predicted[i] /= unit;
    surplus[i] /= unit;
  }
  return surplus.norm() > jump_floor && surplus.norm() > 0.5 * predicted.norm();
}

// Zero modes of the closures with actuators held that move the platform: a singularity of the parallel kind.
bool platform_is_loose(const Eigen::MatrixXd& J_free) {
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(J_free, Eigen::ComputeFullV);
  const auto& sigma = svd.singularValues();
  for (Eigen::Index i = 0; i < J_free.cols(); ++i) {
    const bool zero = i >= sigma.size() || sigma[i] <= rank_threshold * sigma[0];
    if (zero && svd.matrixV().col(i).tail<6>().norm() > 1e-6) return true;
  }
  return false;
}

}  // namespace

Model prepare(const Machine& machine) {
  Model model;
  model.mechanism = compile(machine);
  find_home(machine, model);
  FrameDistances distances;
  for (std::size_t i = 0; i < model.mechanism.chains.size(); ++i) {
    relax_at_home(model.mechanism.chains[i], model.home.chains[i]);
    distances.add(model.mechanism.chains[i], model.home.chains[i], {}, model.home.X_MP.p);
  }
  model.mechanism.length = std::max(0.1, distances.count ? distances.sum / distances.count : 0.0);
  for (const Series& chain : model.mechanism.chains)
    model.mechanism.stiffest = std::max(model.mechanism.stiffest, stiffest(chain, model.mechanism.length));
  return model;
}

Pose tip(const Mechanism& mechanism, const Configuration& configuration) {
  return configuration.X_MP * mechanism.X_PT;
}

bool within_travel(const Mechanism& mechanism, const Eigen::VectorXd& rho) {
  for (Eigen::Index i = 0; i < rho.size(); ++i)
    if (!(rho[i] >= mechanism.travel[i].min && rho[i] <= mechanism.travel[i].max)) return false;
  return true;
}

ActuatorJacobian actuator_jacobian(const Model& model, const Configuration& nominal) {
  const Mechanism& mechanism = model.mechanism;
  if (mechanism.travel.empty()) return {Eigen::MatrixXd::Zero(6, 0), 1};
  const Units units{mechanism.length};
  const WholeSystem whole = closures(mechanism, nominal, units);
  const auto free = moving_columns(whole, {false, true});
  std::vector<int> commanded(mechanism.travel.size());
  for (int i = 0; i < static_cast<int>(whole.variables.size()); ++i)
    if (whole.variables[i].actuator >= 0) commanded[whole.variables[i].actuator] = i;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(rank_threshold);
  const Eigen::MatrixXd J_free = whole.C(Eigen::all, free);
  decomposition.compute(J_free);
  const Eigen::MatrixXd motion = -decomposition.solve(Eigen::MatrixXd(whole.C(Eigen::all, commanded)));
  const TipEquations rows = tip_equations(mechanism, nominal.X_MP, tip(mechanism, nominal));
  const Eigen::MatrixXd J = to_controlled(rows, mechanism, units).rows * motion.bottomRows(6);
  ActuatorJacobian result;
  const Eigen::VectorXd sigma = Eigen::JacobiSVD<Eigen::MatrixXd>(J).singularValues();
  result.condition = sigma.size() == 0 ? 1 : sigma[0] / sigma[sigma.size() - 1];
  if (decomposition.rank() < J_free.cols() && platform_is_loose(J_free))
    result.condition = std::numeric_limits<double>::infinity();
  const auto components = fixed_components(mechanism);
  result.J = units.of_pose()(components).asDiagonal() * J;
  for (Eigen::Index a = 0; a < result.J.cols(); ++a)
    result.J.col(a) /= units.of_column(mechanism.travel[a].kind == JointKind::revolute);
  return result;
}

NominalResult nominal_forward(const Model& model, const Configuration& from, const Eigen::VectorXd& rho) {
  const Mechanism& mechanism = model.mechanism;
  const Eigen::VectorXd start = actuator_values(mechanism, from);
  NominalResult result{Status::unreachable, from};
  double done = 0, step = 1;
  while (done < 1) {
    Configuration next = result.configuration;
    set_actuator_values(mechanism, start + std::min(1.0, done + step) * (rho - start), next);
    if (gauss_newton(mechanism, {false, true}, nullptr, next) > closure_tolerance * 10) {
      if ((step /= 2) < smallest_fraction) return result;
      continue;
    }
    done = std::min(1.0, done + step);
    result.configuration = std::move(next);
  }
  mark_nominal(result.configuration);
  result.status = Status::converged;
  return result;
}

NominalResult follow(const Model& model, const Configuration& from, const Pose& X_MT) {
  const Mechanism& mechanism = model.mechanism;
  const Pose start = tip(mechanism, from);
  NominalResult result{Status::unreachable, from};
  double done = 0, step = 1;
  while (done < 1) {
    const ActuatorJacobian jacobian = actuator_jacobian(model, result.configuration);
    const double reached = std::min(1.0, done + step);
    const Pose now = between(start, X_MT, done), goal = between(start, X_MT, reached);
    Configuration next = result.configuration;
    const bool closed = gauss_newton(mechanism, {true, true}, &goal, next) < closure_tolerance * 10;
    const Eigen::VectorXd drho =
        actuator_values(mechanism, next) - actuator_values(mechanism, result.configuration);
    if (!closed || is_jump(model, jacobian, drho, now, goal)) {
      step /= 2;
      if (step >= smallest_fraction) continue;
      result.status = closed || jacobian.condition > largest_condition ? Status::singular : Status::unreachable;
      return result;
    }
    done = reached;
    result.configuration = std::move(next);
  }
  mark_nominal(result.configuration);
  const bool has_actuators = !mechanism.travel.empty();
  result.status = has_actuators && actuator_jacobian(model, result.configuration).condition > largest_condition
                      ? Status::singular
                      : Status::converged;
  return result;
}

}  // namespace counterflex
