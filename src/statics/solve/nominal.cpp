#include "counterflex/statics/nominal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "statics/model/home.hpp"
#include "statics/model/travel_margin.hpp"
#include "statics/solve/by_parts.hpp"
#include "statics/solve/kinematics.hpp"

namespace counterflex {
namespace {

Pose between(const Pose& from, const Pose& to, double fraction) {
  return moved(from, fraction * difference(to, from));
}

double unit_of(const Mechanism& mechanism, Eigen::Index actuator) {
  return Units{mechanism.length}.of_column(mechanism.travel[actuator].kind == JointKind::revolute);
}

// Whether an actuator step is not what the Jacobian at its start predicts, drho = J^-1 dt.
bool is_jump(const Mechanism& mechanism, const ActuatorJacobian& jacobian, const Eigen::VectorXd& drho,
             const Pose& from, const Pose& to) {
  if (jacobian.J.rows() != jacobian.J.cols()) return false;
  const Vector6 all = difference(to, from);
  Eigen::VectorXd predicted =
      solved(decomposed(jacobian.J), Eigen::VectorXd(all(fixed_components(mechanism))));
  Eigen::VectorXd surplus = drho - predicted;
  double longest = 0;
  for (Eigen::Index a = 0; a < drho.size(); ++a) {
    predicted[a] /= unit_of(mechanism, a);
    surplus[a] /= unit_of(mechanism, a);
    longest = std::max(longest, std::abs(drho[a]) / unit_of(mechanism, a));
  }
  if (longest > largest_step) return true;
  return surplus.norm() > jump_floor && !(surplus.norm() <= same_way * predicted.norm());
}

bool determinant_is_positive(const ActuatorJacobian& jacobian) {
  const Eigen::MatrixXd& J = jacobian.J;
  return J.rows() != J.cols() || J.rows() == 0 || J.determinant() > 0;
}

// Zero modes of the closures with actuators held that move what is controlled: a singularity of the parallel
// kind.
bool platform_is_loose(const Eigen::MatrixXd& J_free, const Eigen::MatrixXd& controlled_rows) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(J_free, Eigen::ComputeFullV);
  const auto& sigma = svd.singularValues();
  for (Eigen::Index i = 0; i < J_free.cols(); ++i) {
    const bool zero = i >= sigma.size() || sigma[i] <= rank_threshold * sigma[0];
    if (zero && (controlled_rows * svd.matrixV().col(i).tail<6>()).norm() > moves_platform) return true;
  }
  return false;
}

// The Jacobian from the closures that `kinematics` makes with actuators held.
ActuatorJacobian jacobian_of(const Mechanism& mechanism, Kinematics& held, const Configuration& nominal) {
  if (mechanism.travel.empty()) return {Eigen::MatrixXd::Zero(6, 0), 1};
  const Units units{mechanism.length};
  const Closures closures = held.closures(nominal, units);
  std::vector<int> commanded(mechanism.travel.size());
  for (int i = 0; i < static_cast<int>(closures.variables.size()); ++i)
    if (closures.variables[i].actuator >= 0) commanded[closures.variables[i].actuator] = i;
  const Eigen::MatrixXd J_free = closures.C(Eigen::all, held.columns(closures));
  const Decomposition decomposition = decomposed(J_free);
  const Eigen::MatrixXd motion = -solved(decomposition, Eigen::MatrixXd(closures.C(Eigen::all, commanded)));
  const Controlled at_tip = tip_equations(mechanism, nominal.X_MP, tip(mechanism, nominal), units);
  ActuatorJacobian result{at_tip.rows * motion.bottomRows(6), 1};
  const Eigen::VectorXd sigma = Eigen::JacobiSVD<Eigen::MatrixXd>(result.J).singularValues();
  if (sigma.size() > 0) result.condition = sigma[0] / sigma[sigma.size() - 1];
  if (decomposition.rank() < J_free.cols() && platform_is_loose(J_free, at_tip.rows))
    result.condition = std::numeric_limits<double>::infinity();
  result.J = units.of_pose()(fixed_components(mechanism)).asDiagonal() * result.J;
  for (Eigen::Index a = 0; a < result.J.cols(); ++a) result.J.col(a) /= unit_of(mechanism, a);
  return result;
}

}  // namespace

bool within_travel(const Mechanism& mechanism, const Eigen::Ref<const Eigen::VectorXd>& rho) {
  for (std::size_t i = 0; i < mechanism.travel.size(); ++i) {
    const double value = shown_value(mechanism.shown, static_cast<Eigen::Index>(i), rho.data());
    if (!(travel_margin(mechanism.travel[i], value) >= 0)) return false;
  }
  return true;
}

Eigen::VectorXd full_turns(const Mechanism& mechanism, const Eigen::VectorXd& rho,
                           const Eigen::VectorXd& near) {
  Eigen::VectorXd turns = Eigen::VectorXd::Zero(rho.size());
  for (std::size_t i = 0; i < mechanism.travel.size(); ++i)
    if (const auto k = static_cast<Eigen::Index>(i); mechanism.travel[i].kind == JointKind::revolute)
      turns[k] = 2 * pi * std::round((near[k] - rho[k]) / (2 * pi));
  return turns;
}

ActuatorJacobian actuator_jacobian(const Model& model, const Configuration& nominal) {
  Kinematics held(model.mechanism, {false, true});
  return jacobian_of(model.mechanism, held, nominal);
}

NominalResult nominal_forward(const Model& model, const Configuration& from, const Eigen::VectorXd& rho) {
  Kinematics kinematics(model.mechanism, {false, true});
  const Eigen::VectorXd start = actuator_values(model.mechanism, from);
  NominalResult result{Status::unreachable, from};
  const bool arrived = by_parts(1, smallest_part, [&](double, double to) {
    Configuration next = result.configuration;
    set_actuator_values(model.mechanism, start + to * (rho - start), next);
    if (!(kinematics.solve(nullptr, next) <= closure_tolerance * 10)) return false;
    result.configuration = std::move(next);
    return true;
  });
  if (!arrived) return result;
  mark_nominal(result.configuration);
  result.status = Status::converged;
  return result;
}

struct NominalPath::Impl {
  const Model& model;
  Kinematics moving, held;
  std::optional<ActuatorJacobian> jacobian;  // at the present place of the path

  bool reaches(const Pose& X_MT, Configuration& configuration) {
    return moving.solve(&X_MT, configuration) < closure_tolerance * 10;
  }

  // Solves for the next target on the way; false where it is not reached or a branch jump shows.
  bool advances(const Pose& now, const Pose& goal, Configuration& configuration) {
    const Mechanism& mechanism = model.mechanism;
    if (!jacobian) jacobian = jacobian_of(mechanism, held, configuration);
    const ActuatorJacobian& here = *jacobian;
    Configuration next = configuration;
    if (!reaches(goal, next)) return false;
    const Eigen::VectorXd drho = actuator_values(mechanism, next) - actuator_values(mechanism, configuration);
    if (is_jump(mechanism, here, drho, now, goal)) return false;
    ActuatorJacobian there = jacobian_of(mechanism, held, next);
    if (determinant_is_positive(there) != determinant_is_positive(here))
      return false;  // a singularity was crossed
    jacobian = std::move(there);
    configuration = std::move(next);
    return true;
  }
};

NominalPath::NominalPath(const Model& model, Configuration start)
    : impl_(std::make_unique<Impl>(Impl{
          model, Kinematics(model.mechanism, {true, true}), Kinematics(model.mechanism, {false, true}), {}})),
      configuration_(std::move(start)) {}
NominalPath::~NominalPath() = default;
NominalPath::NominalPath(NominalPath&&) noexcept = default;
NominalPath& NominalPath::operator=(NominalPath&&) noexcept = default;

Status NominalPath::go_to(const Pose& X_MT) {
  const Mechanism& mechanism = impl_->model.mechanism;
  const Pose start = tip(mechanism, configuration_);
  Configuration reached = configuration_;
  const bool arrived = by_parts(1, smallest_part, [&](double from, double to) {
    return impl_->advances(between(start, X_MT, from), between(start, X_MT, to), reached);
  });
  if (!arrived) {  // what can be reached, but not on this way, lies behind a singularity
    impl_->jacobian.reset();
    return impl_->reaches(X_MT, reached) ? Status::singular : Status::unreachable;
  }
  mark_nominal(reached);
  configuration_ = std::move(reached);
  const bool judged = !mechanism.controlled.empty() && !mechanism.travel.empty();
  return judged && impl_->jacobian->condition > largest_jacobian_condition ? Status::singular
                                                                           : Status::converged;
}

NominalResult follow(const Model& model, const Configuration& from, const Pose& X_MT) {
  NominalPath path(model, from);
  const Status status = path.go_to(X_MT);
  return {status, path.configuration()};
}

}  // namespace counterflex
