#pragma once
/// A machine made ready for computing: every chain, and every branch of a group inside it, as a series of parts with
/// numbered columns. One recursion serves chains and branches: a series runs from its start frame (M for chains, the
/// group's for branches) to its end frame (P for chains).
#include <string>
#include <vector>

#include "counterflex/machine/machine.hpp"

namespace counterflex {

enum class PartKind { fixed, error, actuator, passive, compliance, spring, group, mass };

/// One element of a series. A joint has one column, a spring or a group six (translation first).
struct Part {
  PartKind kind = PartKind::fixed;
  Joint joint;                         ///< actuator, passive, compliance
  Pose X;                              ///< fixed, error; of a mass its place, without rotation
  Vector3 log_R = Vector3::Zero();     ///< error: Log of X.R, so that a fraction of the error can act
  double k = 0;                        ///< passive, compliance: N/m or N m/rad
  double rest = 0;                     ///< passive: value without force
  bool rest_at_home = false;
  double home = 0;                     ///< actuator, passive: start of inverse kinematics
  double offset = 0;                   ///< actuator: added to the commanded value, in the stage's part of gravity
  double mass = 0;                     ///< mass: kg
  Matrix6 K = Matrix6::Zero();         ///< spring
  Vector6 theta_0 = Vector6::Zero();   ///< spring
  int column = -1;                     ///< first column in the series
  int actuator = -1;                   ///< number in the machine
  int group = -1;                      ///< index into Series::groups
};

struct Series;

struct SeriesGroup {
  std::vector<Series> branches;
};

struct Series {
  std::string name;
  std::vector<Part> parts;
  std::vector<SeriesGroup> groups;
  int columns = 0;                   ///< all coordinates and actuators, in order from start to end
  std::vector<int> free;             ///< columns that equilibrium determines (all but actuators)
  std::vector<int> commanded;        ///< columns of this series' own actuators
  std::vector<int> actuators;        ///< numbers of all actuators in it, those of its groups' branches included, ascending
  std::vector<bool> angular;         ///< by column: rad (else m)
  int masses = 0;                    ///< point masses in it, those of branches not counted
  double mass = 0;                   ///< kg, those of branches included
  bool leans = false;                ///< a branch with masses whose start frame turns: where down is, changes for it
};

struct Travel {
  double min, max;
  JointKind kind;
  std::string name{};  ///< see `actuator_names`; numbers alone for a machine with a tool that yields
};

struct Mechanism {
  std::string name;
  std::vector<Series> chains;
  std::vector<Component> controlled;
  std::vector<Travel> travel;  ///< by actuator
  Pose X_PT;
  Vector3 p_EP = Vector3::Zero();  ///< reference point in the frame where the chains end: not zero with a tool that yields
  Vector3 gravity = Vector3::Zero();  ///< m/s2, axes of M; zero where no weights act: then no part is a mass
  double length = 0.1;         ///< l: mean distance of joint and spring frames from the reference point at home, >= 0.1 m
  double stiffest = 0;         ///< k_max, N/m (rotational stiffness divided by l^2)
};

/// The series of `machine`, without home: `prepare` in nominal.hpp also finds the home configuration.
Mechanism compile(const Machine& machine);

/// What the controller adds to the commanded values while weights act (m, rad; by actuator): not zero where its zero was set
/// under the machine's own weight.
Eigen::VectorXd zero_offsets(const Mechanism& mechanism);
void set_zero_offsets(const Eigen::VectorXd& offsets, Mechanism& mechanism);

/// Whether weights act, or a zero set at home (against preloads alone, too): only then does Stage::gravity change anything.
bool has_weight(const Mechanism& mechanism);

/// Whether a spring has a rest value of its own, or a passive joint a spring: only then does the perfect machine without a load
/// and weights deviate from the command.
bool has_preload(const Mechanism& mechanism);

}  // namespace counterflex
