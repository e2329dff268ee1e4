#pragma once
/// A machine made ready for computing, and its states. Every chain, and every branch of a group inside it, is
/// a series of parts with numbered columns. One recursion serves chains and branches: a series runs from its
/// start frame (M for chains, the group's for branches) to its end frame (P for chains).
#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "counterflex/machine/machine.hpp"
#include "counterflex/machine/shown.hpp"
#include "counterflex/statics/motion_errors.hpp"

namespace counterflex {

enum class PartKind { fixed, error, actuator, passive, compliance, spring, group, mass };

/// One element of a series. A joint has one column, a spring or a group six (translation first).
struct Part {
  PartKind kind = PartKind::fixed;
  Joint joint;                      ///< actuator, passive, compliance
  Pose X;                           ///< fixed, error; of a mass its place, without rotation
  Vector3 log_R = Vector3::Zero();  ///< error: Log of X.R, so that a fraction of the error can act
  double k = 0;                     ///< passive, compliance: N/m or N m/rad
  double k_change = 0;              ///< compliance: of k beyond the knee; 0: it is linear
  double knee = 0;                  ///< deflection at which k changes (m, rad)
  double rest = 0;                  ///< passive: value without force
  bool rest_at_home = false;
  double home = 0;              ///< actuator, passive: start of inverse kinematics
  MotionErrors errors{};        ///< actuator: of its motion, a fraction of which can act
  double offset = 0;            ///< actuator: added to the commanded value, in the stage's part of gravity
  double mass = 0;              ///< mass: kg
  Matrix6 K = Matrix6::Zero();  ///< spring
  Vector6 theta_0 = Vector6::Zero();  ///< spring
  int column = -1;                    ///< first column in the series
  int actuator = -1;                  ///< number in the machine
  int group = -1;                     ///< index into Series::groups
};

struct Series;

struct SeriesGroup {
  std::vector<Series> branches;
};

struct Series {
  std::string name;
  std::vector<Part> parts;
  std::vector<SeriesGroup> groups;
  int columns = 0;             ///< all coordinates and actuators, in order from start to end
  std::vector<int> free;       ///< columns that equilibrium determines (all but actuators)
  std::vector<int> commanded;  ///< columns of this series' own actuators
  /// Numbers of all actuators in it, those of its groups' branches included, ascending.
  std::vector<int> actuators;
  std::vector<bool> angular;  ///< by column: rad (else m)
  std::vector<bool> screws;   ///< by column: of an actuator with errors of motion, which slides and turns
  int masses = 0;             ///< point masses in it, those of branches not counted
  double mass = 0;            ///< kg, those of branches included
  bool leans = false;         ///< a branch with masses whose start frame turns: where down is, changes for it

  /// Whether a column turns its end.
  bool turns(int c) const {
    return angular[static_cast<std::size_t>(c)] || screws[static_cast<std::size_t>(c)];
  }
};

/// In values that the control shows, see `Mechanism::shown`.
struct Travel {
  double min, max;
  JointKind kind;
  std::string name{};  ///< see `actuator_names`; numbers alone for a machine with a tool that bends
};

/// The positions in an actuator's table of errors of motion (m, rad).
struct ErrorKnots {
  int actuator = 0;
  std::vector<double> rho;
};

struct Mechanism {
  std::string name;
  std::vector<Series> chains;
  std::vector<Component> controlled;
  std::vector<Travel> travel;    ///< by actuator
  ShownActuators shown;          ///< of the actuator values
  std::vector<double> reversal;  ///< lost motion by actuator (m, rad); empty: none has any
  Pose X_PT;
  /// Reference point in the frame where the chains end: not zero with a tool that bends.
  Vector3 p_EP = Vector3::Zero();
  Vector3 gravity = Vector3::Zero();  ///< m/s2, axes of M; zero where no weights act: then no part is a mass
  bool ends_with_tool_mass = false;   ///< the last mass of the first chain is that of the tool
  /// l: mean distance of joint and spring frames from the reference point at home, >= 0.1 m.
  double length = 0.1;
  /// The least distances of positions in tables of errors of motion (m, rad).
  double error_spacing = std::numeric_limits<double>::infinity();
  double error_spacing_angle = std::numeric_limits<double>::infinity();
  std::vector<ErrorKnots> error_knots;  ///< of all actuators with tables
  bool has_knees = false;               ///< of compliances
  std::optional<Fixture> fixture;       ///< of the part: no solver knows of it, see statics/fixture.hpp
  double stiffest = 0;                  ///< k_max, N/m (rotational stiffness divided by l^2)
};

/// The series of `machine`, without home: `prepare` in nominal.hpp also finds the home configuration.
Mechanism compile(const Machine& machine);

/// Whether the machine controls a component of its tip's pose.
bool controls(const Mechanism& mechanism, Component component);

/// Whether actuators go straight where the tip does: one chain of slides.
bool only_slides(const Mechanism& mechanism);

/// Whether the deviation may bend to one side and then to the other between places that are close: with
/// tables of errors and knees.
inline bool may_wave(const Mechanism& mechanism) {
  return mechanism.has_knees || !mechanism.error_knots.empty();
}

/// Whether weights act, or a zero set at home (against preloads alone, too): only then does Stage::gravity
/// change anything.
bool has_weight(const Mechanism& mechanism);

/// Whether a spring has a rest value of its own, or a passive joint a spring: only then does the perfect
/// machine without a load and weights deviate from the command.
bool has_preload(const Mechanism& mechanism);

struct SeriesState;

struct GroupState {
  Pose X;  ///< of the group's end in its start frame
  std::vector<SeriesState> branches;
};

struct SeriesState {
  Eigen::VectorXd x;          ///< by column (m, rad); a group's six entries are unused
  Eigen::VectorXd x_nominal;  ///< the same in the nominal configuration from which this one was continued
  /// Wrench exerted on the end (N, N m), at the end's origin, axes of the start frame.
  Vector6 F = Vector6::Zero();
  std::vector<GroupState> groups;
};

struct Configuration {
  Pose X_MP;
  std::vector<SeriesState> chains;
};

/// A configuration with every coordinate zero.
Configuration zero_configuration(const Mechanism& mechanism);

/// Values of all actuators (m, rad).
Eigen::VectorXd actuator_values(const Mechanism& mechanism, const Configuration& configuration);
void set_actuator_values(const Mechanism& mechanism, const Eigen::VectorXd& rho,
                         Configuration& configuration);

/// How much of what is not nominal acts. The continuation to a loaded, imperfect machine runs from 0 to 1 in
/// all of them.
struct Stage {
  double errors = 1;  ///< assembly errors: s p, Exp(s Log R)
  double load = 1;    ///< the applied wrench
  /// Passive springs as k (q - q_nom) + s k (q_nom - q_rest), springs as K (theta - s theta_0).
  double preload = 1;
  double gravity = 1;  ///< the weights of all masses, and what the controller's zero holds against them

  bool operator==(const Stage&) const = default;
};
inline constexpr Stage nominal_stage{0, 0, 0, 0};

/// An actuator that has a limit: its shown value, how far the nearer limit is (m or rad; negative: outside),
/// and that as a share of the travel (of 1 m or 1 rad where there is one limit only).
struct AxisPlace {
  std::size_t actuator = 0;
  double value = 0, margin = 0, share = 0;
};

/// The actuator nearest to an end of its travel, or farthest outside it, for actuator values `rho`. Linear
/// and rotary axes are compared in shares of their travel. None where no actuator has a limit.
std::optional<AxisPlace> tightest_axis(const Mechanism& mechanism, const Eigen::VectorXd& rho);

/// How far two sets of actuator values are apart (m, rad); full turns of a rotary one count as nothing.
double actuator_distance(const Mechanism& mechanism, const Eigen::VectorXd& a, const Eigen::VectorXd& b);

/// "138.0 mm", "-12.5 deg": the shown value of an actuator.
std::string axis_value(const Travel& travel, double value);

/// "-300 to 0 mm", "from -10 deg": the travel of an actuator.
std::string travel_range(const Travel& travel);

/// "axis Z: 138.0 mm is outside its travel (-300 to 0 mm)".
std::string outside_travel_words(const Travel& travel, double value);

}  // namespace counterflex
