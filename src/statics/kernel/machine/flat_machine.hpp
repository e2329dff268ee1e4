#pragma once
/// A machine as flat arrays: what the kernel reads. Compiled from a Model by `flatten`. EQUATIONS.md,
/// section 11.
///
/// A series is a row of six-elements: springs, and groups of branches. Between two six-elements is a
/// node, whose pose is an unknown; the last element of a chain ends at the platform. Joints between a node
/// and the element behind it
/// (`front`) and between the element and the node at its end (`after`) belong to the element.
#include <array>
#include <vector>

#include "counterflex/statics/motion_errors.hpp"

namespace counterflex::kernel {

/// A rigid transform; the flags show which parts are not zero.
struct Transform {
  std::array<double, 9> R{1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< row by row
  std::array<double, 3> p{};                           ///< m
  bool turns = false, shifts = false;
};

enum class StepKind { transform, slide, turn, weight };

/// One step from frame to frame: a rigid transform, or a joint along or about a coordinate axis of the frame
/// before. A weight does not change the frame.
struct FrameStep {
  StepKind kind = StepKind::transform;
  int weight = -1;       ///< index into FlatMachine::weights
  int transform = -1;    ///< index into a table of transforms; inverted where it is passed backwards
  int axis = 0;          ///< of a joint: 0 x, 1 y, 2 z
  double sign = 1;       ///< -1: the joint's axis points against it
  double direction = 1;  ///< +1: passed from base to platform, -1: backwards
  int joint = -1;        ///< number of the joint in the state
  int actuator = -1;     ///< number of the actuator; -1: the joint is free
  int motion = -1;       ///< of an actuator with errors of its motion: index into FlatMachine::motions
  double k = 0;          ///< of a free joint: N/m or N m/rad
  double k_change = 0;   ///< of a free joint beyond its knee; 0: it is linear
  double knee = 0;       ///< its deflection there (m, rad)
  double rest = 0;       ///< value without force (m, rad)
  /// Its spring is relaxed in the nominal configuration, as far as preloads do not act.
  bool passive = false;
  /// Of a free joint: first of its stored couplings, one for each actuator that is eliminated before.
  int coupling = 0;
  int actuators_before = 0;

  bool is_joint() const { return kind == StepKind::slide || kind == StepKind::turn; }
};

/// The motion of an actuator with errors. Its axis may have any direction.
struct ErrorMotion {
  bool turns = false;
  std::array<double, 3> axis{};
  MotionErrors errors{};
};

/// Its numbers at one value: rotation row by row and position of the frame behind it, and the velocities of
/// that frame, in the frame before it.
using MotionNumbers = std::array<double, 18>;

/// At the joint value `q`, which is `offset` more than the commanded one, with a share of the errors.
MotionNumbers motion_numbers(const ErrorMotion& motion, double q, double offset, double share);

enum class ElementKind { spring, group };

struct Element {
  ElementKind kind = ElementKind::spring;
  int front = 0, fronts = 0;     ///< steps from the start frame to the element
  int after = 0, afters = 0;     ///< steps from the end frame back to the element
  int spring = -1;               ///< index into FlatMachine::springs
  int series = 0, branches = 0;  ///< of a group: its branches
  int node = -1;                 ///< number of the node at its end; -1: the end of the series
  int slots = 0;  ///< of its actuators, in the order of elimination: the first in FlatMachine::slots
};

/// A point mass that rides with a node, with the start or the end of a series, or hangs between the joints
/// before an element.
struct Weight {
  double mass = 0;     ///< kg
  int transform = -1;  ///< from that frame to the mass
};

/// The weights that ride with one frame.
struct Weights {
  int first = 0, count = 0;  ///< into FlatMachine::weights
};

struct Series {
  int first = 0, count = 0;               ///< elements
  int actuators = 0, actuator_count = 0;  ///< of all in it: into FlatMachine::actuators, by slot
  Weights at_start, at_end;               ///< at_start: of a branch; those at the base do no work
};

enum class SpringShape {
  full,
  beam,
  diagonal,
  isotropic
};  ///< beam: diagonal blocks diagonal, off-diagonal ones without diagonal

struct Spring {
  std::array<double, 36> K{};
  std::array<double, 6> theta_0{};
  SpringShape shape = SpringShape::full;
  double tangent_factor = 1;  ///< of an isotropic one: its K in tangents over that in forces
};

struct FlatMachine {
  std::vector<FrameStep> steps;
  std::vector<Element> elements;
  std::vector<Series> series;  ///< the chains first
  std::vector<Spring> springs;
  std::vector<ErrorMotion> motions;
  std::vector<int> slots;      ///< Element::slots
  std::vector<int> actuators;  ///< Series::actuators: numbers of actuators
  std::vector<Weight> weights;
  std::vector<Weights> weights_of_node;  ///< by node
  std::vector<int> actuator_joint;       ///< by actuator: its joint
  /// By actuator: what the controller's zero adds while weights act (m, rad).
  std::vector<double> actuator_offset;
  std::vector<char> joint_turns;  ///< by joint
  int chains = 0, joints = 0, nodes = 0, couplings = 0;
  int most_actuators = 0;            ///< of one series
  bool has_knees = false;            ///< of a joint
  bool has_hanging_weights = false;  ///< in branches, or before an element: tangents leave out how these turn
  int rigid_closures = 0;            ///< pairs of springs K and -K: each has six negative pivots
  std::array<bool, 6> controlled{};
  Transform X_PT;                   ///< the tip in the platform's frame
  std::array<double, 3> p_arm{};    ///< where the load acts, in the platform's frame (m)
  std::array<double, 3> gravity{};  ///< m/s2, axes of M
  double length = 0.1;              ///< l (m)
  double stiffest = 0;              ///< k_max (N/m)

  /// Joints; the twists of each node, of the platform.
  int unknowns() const { return joints + 6 * nodes + 6; }
  /// Joints; R row by row and p of each node, of the platform.
  int state_size() const { return joints + 12 * nodes + 12; }
};

}  // namespace counterflex::kernel
