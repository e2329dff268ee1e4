#pragma once
/// The whole static system, uncondensed: all coordinates of all chains and branches, the platform's pose, and
/// the wrenches of all closures. It decides what the condensed form cannot: `singular`, `unstable`, and steps
/// of chains that are singular on their own. Nominal kinematics takes its closures from it. EQUATIONS.md,
/// section 6.
#include <optional>
#include <vector>

#include "statics/model/tip.hpp"
#include "statics/theory/series.hpp"

namespace counterflex {

/// What a variable is. Variables: columns of all series, then the platform's six.
struct Variable {
  bool angular = false;
  bool elastic = false;  ///< a spring's or compliance's coordinate: zero in nominal kinematics
  int actuator = -1;     ///< its number, where it is one
};

/// The closures of all chains and branches, C dv = gap, without unit.
struct Closures {
  std::vector<Variable> variables;
  Eigen::MatrixXd C;
  Eigen::VectorXd gap;
  int pose = 0;  ///< first of the platform's variables
};

///     [ A  -C' ] [ dv      ]   [ -gradient ]
///     [ C   0  ] [ dlambda ] = [  gap      ]        v: variables, lambda: wrenches of closures, all without
///     unit
struct WholeSystem : Closures {
  Eigen::MatrixXd A;
  Eigen::VectorXd gradient;
  double wrench = 0;  ///< largest that acts or is carried, at least 1 N; without unit
  /// How far the forces are from balance, at most what a solution may miss; without unit.
  double force_error = 0;
};

/// The platform's balance: sum of chain wrenches minus applied wrench, and the applied wrench's tangent.
struct PlatformTerms {
  Vector6 gradient = Vector6::Zero();
  Matrix6 A = Matrix6::Zero();
};

/// From evaluated works (not condensed ones).
Closures assemble_closures(const Mechanism& mechanism, const std::vector<SeriesWork>& works,
                           const Units& units);
WholeSystem assemble_whole(const Mechanism& mechanism, const std::vector<SeriesWork>& works,
                           const PlatformTerms& platform, const Units& units);

/// A step of variables and wrenches, in SI, in the order of `WholeSystem`.
struct WholeStep {
  Eigen::VectorXd variables, wrenches;
  Eigen::VectorXd forces;  ///< along the controlled rows, where these are met by forces (N)
  bool redundant = false;  ///< the minimum-norm choice among several
};

/// Minimum-norm solution. Actuators are held, unless `controlled` is given: then they are unknowns, or forces
/// are.
WholeStep solve_whole(const WholeSystem& system, const std::optional<Controlled>& controlled,
                      const Units& units);

/// Given changes of an equilibrium, one a column: of the variables that are held (SI), and of the gradient at
/// unchanged variables (without unit).
struct HeldSteps {
  std::vector<bool> is_held;  ///< besides the actuators; by variable
  Eigen::MatrixXd held, gradient;
};

/// The steps of all variables (SI), one a column, that keep the equilibrium; minimum-norm ones where closures
/// are redundant.
Eigen::MatrixXd solve_held(const WholeSystem& system, const HeldSteps& given, const Units& units);

/// Adds a step to a configuration; returns its largest entry (m, rad times l).
double apply(const Mechanism& mechanism, const WholeStep& step, const Units& units,
             Configuration& configuration);

/// Condition of the system with actuators held, redundant closures and zero modes that move no platform taken
/// out; infinite where a zero mode moves the platform. A coordinate that is stiffer than 1e9 N/m counts as
/// one of 1e9 N/m: a stiff spring alone makes no machine singular. `weakest` is the platform's twist (m, rad;
/// norm 1 without unit).
struct Condition {
  double value = 0;
  Vector6 weakest = Vector6::Zero();
  bool indeterminate = false;  ///< redundant closures were found: some wrenches are the minimum-norm ones
};
Condition condition(const WholeSystem& system, const Units& units);

/// Of one chain whose end is held: whether the wrench on its end is determined. Redundant closures of its
/// branches and zero modes inside it are allowed.
bool determines_end(const WholeSystem& system);

/// The condition is at most this; infinite where the system has zero modes.
double condition_bound(const WholeSystem& system);

/// Least eigenvalue of the symmetric part of A on the null space of C, actuators held, every coordinate
/// scaled by its own stiffness first. A negative one within its rounding error is 0. EQUATIONS.md, section 6.
double least_scaled_eigenvalue(const WholeSystem& system);

}  // namespace counterflex
