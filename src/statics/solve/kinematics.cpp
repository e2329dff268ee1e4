#include "statics/solve/kinematics.hpp"

#include <cmath>

namespace counterflex {
namespace {

const Units kinematic_units{1.0};  // angles scaled by 1 m

}  // namespace

Kinematics::Kinematics(const Mechanism& mechanism, Moving moving) : mechanism_(mechanism), moving_(moving) {
  for (const Series& chain : mechanism.chains) works_.push_back(make_work(chain));
}

Closures Kinematics::closures(const Configuration& configuration, const Units& units) {
  for (std::size_t i = 0; i < works_.size(); ++i)
    evaluate(mechanism_.chains[i], configuration.chains[i], configuration.X_MP, nominal_stage,
             Vector3::Zero(), Hessians::no, works_[i]);
  return assemble_closures(mechanism_, works_, units);
}

std::vector<int> Kinematics::columns(const Closures& closures) const {
  std::vector<int> list;
  for (int i = 0; i < static_cast<int>(closures.variables.size()); ++i) {
    const Variable& variable = closures.variables[i];
    if (i >= closures.pose ? moving_.platform
                           : !variable.elastic && (moving_.actuators || variable.actuator < 0))
      list.push_back(i);
  }
  return list;
}

Kinematics::Equations Kinematics::equations(const Pose* X_MT, const Configuration& configuration) {
  Equations equations{closures(configuration, kinematic_units), std::nullopt};
  if (X_MT) equations.tip = tip_equations(mechanism_, configuration.X_MP, *X_MT, kinematic_units);
  return equations;
}

Eigen::VectorXd Kinematics::Equations::errors() const {
  if (!tip) return closures.gap;
  Eigen::VectorXd all(closures.gap.size() + tip->rhs.size());
  all << closures.gap, tip->rhs;
  return all;
}

void Kinematics::linearise(const Equations& equations) {
  const Eigen::MatrixXd& C = equations.closures.C;
  const auto moving = columns(equations.closures);
  const Eigen::Index targets = equations.tip ? equations.tip->rhs.size() : 0;
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(C.rows() + targets, static_cast<Eigen::Index>(moving.size()));
  J.topRows(C.rows()) = C(Eigen::all, moving);
  if (equations.tip) J.bottomRightCorner(targets, 6) = equations.tip->rows;
  decomposition_ = decomposed(J);
  is_linearised_ = true;
}

double Kinematics::step(const Eigen::VectorXd& x, const Closures& closures,
                        Configuration& configuration) const {
  WholeStep whole;
  whole.variables.setZero(static_cast<Eigen::Index>(closures.variables.size()));
  whole.variables(columns(closures)) = x;
  whole.wrenches.setZero(closures.C.rows());
  return apply(mechanism_, whole, kinematic_units, configuration);
}

double Kinematics::solve(const Pose* X_MT, Configuration& configuration) {
  Equations now = equations(X_MT, configuration);
  if (columns(now.closures).empty()) return now.errors().norm();  // springs alone between base and platform
  double size = now.errors().norm();
  for (int iteration = 0; iteration < most_newton_steps; ++iteration) {
    const bool fresh = !is_linearised_;
    if (fresh) linearise(now);
    const Eigen::VectorXd x = solved(decomposition_, now.errors());
    const Configuration before = configuration;
    Equations then;
    double moved_by = 0, damping = 1, next = 0;
    for (;; damping /= 2) {
      configuration = before;
      moved_by = step(damping * x, now.closures, configuration);
      then = equations(X_MT, configuration);
      next = then.errors().norm();
      if (next < size || next < closure_tolerance || !fresh) break;
      if (damping < smallest_part) {  // no step leads nearer: the target is not reached
        configuration = before;
        return size;
      }
    }
    // An old linearisation that no longer contracts is thrown away, and so is its step if that made things
    // worse.
    is_linearised_ = next <= slow_contraction * size || next < closure_tolerance;
    if (!fresh && !(next < size) && next >= closure_tolerance) {
      configuration = before;
      continue;
    }
    now = std::move(then);
    size = next;
    if (moved_by < step_tolerance || !std::isfinite(size)) break;
  }
  return size;
}

}  // namespace counterflex
