#include "counterflex/statics/nominal.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "statics/model/home_reference.hpp"
#include "statics/solve/kinematics.hpp"
#include "statics/model/part_pose.hpp"

namespace counterflex {
namespace {

constexpr double home_tolerance = 1e-7;
constexpr double largest_jacobian_condition = 1e6, smallest_fraction = 1e-5;
constexpr double largest_step =
    0.5;  // of an actuator at once, in units of l or rad: two folds lie further apart

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
      start_at_joint_homes(series.groups[part.group].branches[b], group.branches[b],
                           work.groups[part.group][b]);
    group.X = work.groups[part.group][0].end;
  }
  evaluate(series, state, {}, nominal_stage, Vector3::Zero(), Hessians::no, work);
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
  model.home_gap = Kinematics(mechanism, moving).solve(nullptr, model.home);
  model.home_status = model.home_gap < home_tolerance ? Status::converged : Status::unreachable;
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
      if (part.kind == PartKind::group)
        for (std::size_t b = 0; b < state.groups[part.group].branches.size(); ++b)
          add(series.groups[part.group].branches[b], state.groups[part.group].branches[b], X, reference);
      X = X * part_pose(part, state, nominal_stage);
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

// Whether an actuator step is not what the Jacobian at its start predicts.
bool is_jump(const Mechanism& mechanism, const InverseJacobian& jacobian, const Eigen::VectorXd& drho,
             const Pose& from, const Pose& to) {
  if (jacobian.matrix.rows() != jacobian.matrix.cols()) return false;
  const Vector6 all = difference(to, from);
  Eigen::VectorXd predicted = jacobian.matrix * all(fixed_components(mechanism)), surplus = drho - predicted;
  double longest = 0;
  for (Eigen::Index i = 0; i < drho.size(); ++i) {
    const double unit = mechanism.travel[i].kind == JointKind::prismatic ? mechanism.length : 1.0;
    predicted[i] /= unit;
    surplus[i] /= unit;
    longest = std::max(longest, std::abs(drho[i]) / unit);
  }
  if (longest > largest_step) return true;
  return surplus.norm() > jump_floor && !(surplus.norm() <= 0.5 * predicted.norm());
}

bool determinant_is_positive(const InverseJacobian& jacobian) {
  const auto& J = jacobian.matrix;
  return J.rows() != J.cols() || J.rows() == 0 || J.determinant() > 0;
}

// Zero modes of the closures with actuators held that move what is controlled: a singularity of the parallel
// kind.
bool platform_is_loose(const Eigen::MatrixXd& J_free, const Eigen::MatrixXd& controlled_rows) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(J_free, Eigen::ComputeFullV);
  const auto& sigma = svd.singularValues();
  for (Eigen::Index i = 0; i < J_free.cols(); ++i) {
    const bool zero = i >= sigma.size() || sigma[i] <= rank_threshold * sigma[0];
    if (zero && (controlled_rows * svd.matrixV().col(i).tail<6>()).norm() > 1e-6) return true;
  }
  return false;
}

}  // namespace

Model prepare(const Machine& machine) {
  Model model;
  model.mechanism = compile(machine);
  find_home(machine, model);
  settle_at_home(model);
  if (machine.gravity.true_at_home && model.home_status == Status::converged) hold_home(model);
  return model;
}

void settle_at_home(Model& model) {
  mark_nominal(model.home);
  FrameDistances distances;
  for (std::size_t i = 0; i < model.mechanism.chains.size(); ++i) {
    relax_at_home(model.mechanism.chains[i], model.home.chains[i]);
    distances.add(model.mechanism.chains[i], model.home.chains[i], {}, model.home.X_MP.p);
  }
  model.mechanism.length = std::max(0.1, distances.count ? distances.sum / distances.count : 0.0);
  for (const Series& chain : model.mechanism.chains)
    model.mechanism.stiffest = std::max(model.mechanism.stiffest, stiffest(chain, model.mechanism.length));
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
  std::vector<SeriesWork> works;
  for (const Series& chain : mechanism.chains) works.push_back(make_work(chain));
  const WholeSystem whole = Kinematics::closures(mechanism, works, nominal, units);
  const auto free = moving_columns(whole, {false, true});
  std::vector<int> commanded(mechanism.travel.size());
  for (int i = 0; i < static_cast<int>(whole.variables.size()); ++i)
    if (whole.variables[i].actuator >= 0) commanded[whole.variables[i].actuator] = i;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(rank_threshold);
  const Eigen::MatrixXd J_free = whole.C(Eigen::all, free);
  decomposition.compute(J_free);
  const Eigen::MatrixXd motion = -solved(decomposition, Eigen::MatrixXd(whole.C(Eigen::all, commanded)));
  const TipEquations rows = tip_equations(mechanism, nominal.X_MP, tip(mechanism, nominal));
  const Eigen::MatrixXd controlled_rows = to_controlled(rows, mechanism, units).rows;
  const Eigen::MatrixXd J = controlled_rows * motion.bottomRows(6);
  ActuatorJacobian result;
  const Eigen::VectorXd sigma = Eigen::JacobiSVD<Eigen::MatrixXd>(J).singularValues();
  result.condition = sigma.size() == 0 ? 1 : sigma[0] / sigma[sigma.size() - 1];
  if (decomposition.rank() < J_free.cols() && platform_is_loose(J_free, controlled_rows))
    result.condition = std::numeric_limits<double>::infinity();
  const auto components = fixed_components(mechanism);
  result.J = units.of_pose()(components).asDiagonal() * J;
  for (Eigen::Index a = 0; a < result.J.cols(); ++a)
    result.J.col(a) /= units.of_column(mechanism.travel[a].kind == JointKind::revolute);
  return result;
}

NominalResult nominal_forward(const Model& model, const Configuration& from, const Eigen::VectorXd& rho) {
  const Mechanism& mechanism = model.mechanism;
  Kinematics kinematics(mechanism, {false, true});
  const Eigen::VectorXd start = actuator_values(mechanism, from);
  NominalResult result{Status::unreachable, from};
  double done = 0, step = 1;
  while (done < 1) {
    Configuration next = result.configuration;
    set_actuator_values(mechanism, start + std::min(1.0, done + step) * (rho - start), next);
    if (!(kinematics.solve(nullptr, next) <= closure_tolerance * 10)) {
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

struct NominalPath::Impl {
  const Model& model;
  Kinematics kinematics;
  InverseJacobian jacobian;
  bool has_jacobian = false;

  // Solves for the next target on the way; false where it is not reached or a branch jump shows.
  bool advance(const Pose& now, const Pose& goal, Configuration& configuration) {
    const Mechanism& mechanism = model.mechanism;
    if (!has_jacobian) look_at(now, configuration);
    const Eigen::VectorXd before = actuator_values(mechanism, configuration);
    Configuration next = configuration;
    const bool closed = kinematics.solve(&goal, next) < closure_tolerance * 10;
    const Eigen::VectorXd drho = actuator_values(mechanism, next) - before;
    if (!closed || is_jump(mechanism, jacobian, drho, now, goal)) {
      has_jacobian = false;
      return false;
    }
    const bool positive = determinant_is_positive(jacobian);
    look_at(goal, next);
    if (determinant_is_positive(jacobian) != positive) {  // a singularity was crossed on the way
      has_jacobian = false;
      return false;
    }
    configuration = std::move(next);
    return true;
  }

  void look_at(const Pose& X_MT, const Configuration& configuration) {
    kinematics.linearise(configuration, &X_MT);
    jacobian = kinematics.inverse_jacobian();
    has_jacobian = true;
  }
};

NominalPath::NominalPath(const Model& model, Configuration start)
    : impl_(std::make_unique<Impl>(Impl{model, Kinematics(model.mechanism, {true, true}), {}})),
      configuration_(std::move(start)) {}
NominalPath::~NominalPath() = default;
NominalPath::NominalPath(NominalPath&&) noexcept = default;
NominalPath& NominalPath::operator=(NominalPath&&) noexcept = default;

Status NominalPath::go_to(const Pose& X_MT) {
  const Mechanism& mechanism = impl_->model.mechanism;
  const Pose start = tip(mechanism, configuration_);
  Configuration reached = configuration_;
  double done = 0, step = 1;
  while (done < 1) {
    const double next = std::min(1.0, done + step);
    if (impl_->advance(between(start, X_MT, done), between(start, X_MT, next), reached)) {
      done = next;
      continue;
    }
    if ((step /= 2) >= smallest_fraction) continue;
    impl_->has_jacobian = false;
    // What can be reached, but not on this way, lies behind a singularity.
    Configuration beyond = reached;
    return impl_->kinematics.solve(&X_MT, beyond) < closure_tolerance * 10 ? Status::singular
                                                                           : Status::unreachable;
  }
  mark_nominal(reached);
  configuration_ = std::move(reached);
  const bool judged = !mechanism.controlled.empty() && !mechanism.travel.empty();
  return judged && impl_->jacobian.condition > largest_jacobian_condition ? Status::singular
                                                                          : Status::converged;
}

NominalResult follow(const Model& model, const Configuration& from, const Pose& X_MT) {
  NominalPath path(model, from);
  const Status status = path.go_to(X_MT);
  return {status, path.configuration()};
}

}  // namespace counterflex
