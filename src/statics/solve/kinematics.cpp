#include "statics/solve/kinematics.hpp"

#include <cmath>
#include <limits>

namespace counterflex {
namespace {

constexpr double slow_contraction = 0.1, consistent = 1e-6;
constexpr int most_kinematic_steps = 60;
const Units kinematic_units{1.0};  // angles scaled by 1 m

void collect_gaps(const SeriesWork& work, Eigen::VectorXd& gaps, Eigen::Index& at) {
  gaps.segment<6>(at) = work.gap;
  at += 6;
  for (const auto& group : work.groups)
    for (const SeriesWork& branch : group) collect_gaps(branch, gaps, at);
}

void evaluate_nominal(const Mechanism& mechanism, const Configuration& configuration, std::vector<SeriesWork>& works) {
  for (std::size_t i = 0; i < mechanism.chains.size(); ++i)
    evaluate(mechanism.chains[i], configuration.chains[i], configuration.X_MP, nominal_stage, Vector3::Zero(),
             Hessians::no, works[i]);
}

Eigen::Index closure_rows(const SeriesWork& work) {
  Eigen::Index rows = 6;
  for (const auto& group : work.groups)
    for (const SeriesWork& branch : group) rows += closure_rows(branch);
  return rows;
}

}  // namespace

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

WholeSystem Kinematics::closures(const Mechanism& mechanism, std::vector<SeriesWork>& works,
                                 const Configuration& configuration, const Units& units) {
  evaluate_nominal(mechanism, configuration, works);
  return assemble_whole(mechanism, works, {}, units);
}

Kinematics::Kinematics(const Mechanism& mechanism, Moving moving) : mechanism_(mechanism), moving_(moving) {
  for (const Series& chain : mechanism.chains) {
    works_.push_back(make_work(chain));
    closures_ += closure_rows(works_.back());
  }
  decomposition_.setThreshold(rank_threshold);
}

void Kinematics::linearise(const Configuration& configuration, const Pose* X_MT) {
  const WholeSystem whole = closures(mechanism_, works_, configuration, kinematic_units);
  if (columns_.empty()) {
    columns_ = moving_columns(whole, moving_);
    actuator_columns_.resize(mechanism_.travel.size());
    for (std::size_t i = 0; i < columns_.size(); ++i)
      if (whole.variables[columns_[i]].actuator >= 0)
        actuator_columns_[whole.variables[columns_[i]].actuator] = static_cast<int>(i);
  }
  variables_ = static_cast<Eigen::Index>(whole.variables.size());
  const Eigen::Index targets = X_MT ? static_cast<Eigen::Index>(fixed_components(mechanism_).size()) : 0;
  J_.setZero(closures_ + targets, static_cast<Eigen::Index>(columns_.size()));
  J_.topRows(closures_) = whole.C(Eigen::all, columns_);
  if (X_MT)
    J_.bottomRightCorner(targets, 6) =
        to_controlled(tip_equations(mechanism_, configuration.X_MP, *X_MT), mechanism_, kinematic_units).rows;
  is_linearised_ = true;
  if (J_.size() > 0) decomposition_.compute(J_);
}

Eigen::VectorXd Kinematics::errors(const Pose* X_MT, const Configuration& configuration) {
  evaluate_nominal(mechanism_, configuration, works_);
  const Eigen::Index targets = X_MT ? static_cast<Eigen::Index>(fixed_components(mechanism_).size()) : 0;
  Eigen::VectorXd all(closures_ + targets);
  Eigen::Index at = 0;
  for (const SeriesWork& work : works_) collect_gaps(work, all, at);
  if (X_MT)
    all.tail(targets) =
        to_controlled(tip_equations(mechanism_, configuration.X_MP, *X_MT), mechanism_, kinematic_units).rhs;
  return all;
}

double Kinematics::step(const Eigen::VectorXd& x, Configuration& configuration) const {
  WholeStep whole;
  whole.variables.setZero(variables_);
  whole.variables(columns_) = x;
  whole.wrenches.setZero(closures_);
  return apply(mechanism_, whole, kinematic_units, configuration);
}

double Kinematics::solve(const Pose* X_MT, Configuration& configuration) {
  Eigen::VectorXd error = errors(X_MT, configuration);
  double size = error.norm();
  for (int iteration = 0; iteration < most_kinematic_steps; ++iteration) {
    const bool fresh = !is_linearised_;
    if (fresh) linearise(configuration, X_MT);
    if (J_.size() == 0) return size;  // nothing moves: springs alone between base and platform
    const Eigen::VectorXd x = solved(decomposition_, error);
    const Configuration before = configuration;
    double moved_by = 0, damping = 1;
    for (;; damping /= 2) {
      configuration = before;
      moved_by = step(damping * x, configuration);
      error = errors(X_MT, configuration);
      if (error.norm() < size || error.norm() < closure_tolerance || !fresh || damping < 1e-3) break;
    }
    // An old linearisation that no longer contracts is thrown away, and so is its step if that made things worse.
    is_linearised_ = error.norm() <= slow_contraction * size || error.norm() < closure_tolerance;
    if (!fresh && !(error.norm() < size) && error.norm() >= closure_tolerance) {
      configuration = before;
      error = errors(X_MT, configuration);
      continue;
    }
    size = error.norm();
    if ((size < closure_tolerance && moved_by < step_tolerance) || moved_by < 1e-15 || !std::isfinite(size)) break;
  }
  return size;
}

// Zero modes that move an actuator: the target does not determine it.
bool Kinematics::has_free_motion() const {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(J_, Eigen::ComputeFullV);
  const auto& sigma = svd.singularValues();
  for (Eigen::Index i = 0; i < J_.cols(); ++i) {
    if (i < sigma.size() && sigma[i] > rank_threshold * sigma[0]) continue;
    const Eigen::VectorXd mode = svd.matrixV().col(i);
    if (mode(actuator_columns_).norm() > consistent) return true;
  }
  return false;
}

InverseJacobian Kinematics::inverse_jacobian() const {
  const auto targets = J_.rows() - closures_, actuators = static_cast<Eigen::Index>(actuator_columns_.size());
  Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(J_.rows(), targets);
  unit.bottomRows(targets).setIdentity();
  const Eigen::MatrixXd motion = solved(decomposition_, unit);
  InverseJacobian result{motion(actuator_columns_, Eigen::all), 1};
  if (actuators != targets) return result;
  Eigen::MatrixXd scaled = result.matrix;
  const auto components = fixed_components(mechanism_);
  const Vector6 pose = Units{mechanism_.length}.of_pose();
  for (Eigen::Index a = 0; a < actuators; ++a)
    scaled.row(a) /= mechanism_.travel[a].kind == JointKind::prismatic ? mechanism_.length : 1.0;
  for (Eigen::Index c = 0; c < targets; ++c) scaled.col(c) *= pose[components[c]];
  const Eigen::VectorXd sigma = Eigen::JacobiSVD<Eigen::MatrixXd>(scaled).singularValues();
  const bool inconsistent = (J_ * motion - unit).norm() > consistent;
  const bool free = decomposition_.rank() < J_.cols() && has_free_motion();
  result.condition = inconsistent || free ? std::numeric_limits<double>::infinity() : sigma[0] / sigma[targets - 1];
  return result;
}

}  // namespace counterflex
