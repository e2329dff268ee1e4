#pragma once
/// A machine as data: what `machine.toml` says, checked, in SI units. A machine is a base, a platform and
/// chains of elements between them; each element is a transform from the frame before it to the frame after
/// it. Frames: machine M (the base), platform P (its origin is the reference point), tool tip T, work frame
/// W.
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "counterflex/files/input_error.hpp"
#include "counterflex/geometry/pose.hpp"
#include "counterflex/machine/load_limits.hpp"

namespace counterflex {

enum class JointKind { prismatic, revolute };

/// Motion along or about a unit `axis` of the frame before the joint; values in m or rad.
struct Joint {
  JointKind kind = JointKind::prismatic;
  Vector3 axis = Vector3::UnitX();
};

/// A fixed transform.
struct Rigid {
  Pose X;
};

/// An assembly error: a fixed transform of the real machine, identity in the nominal one.
struct AssemblyError {
  std::string name;
  Pose X;
};

/// A joint whose value is commanded. Actuators are numbered in the order of chains, then of elements (a
/// group's branches in order, where the group stands).
struct Actuator {
  Joint joint;
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  double home = 0;  ///< where inverse kinematics starts
};

/// A joint that moves freely, or against `stiffness` (N/m or N m/rad) with energy 1/2 k (q - rest)^2.
struct Passive {
  Joint joint;
  double stiffness = 0;
  double rest = 0;
  bool rest_at_home = false;  ///< `rest` is the joint's value in the nominal home configuration
  double home = 0;            ///< where inverse kinematics starts
  double min = -std::numeric_limits<double>::infinity();  ///< range as the file has it; nothing watches it
  double max = std::numeric_limits<double>::infinity();
};

/// Six coordinates theta = (p, phi), transform [Exp(phi), p], energy 1/2 (theta - theta_0)' K (theta -
/// theta_0). K (6x6, symmetric positive semidefinite, SI) in the axes of the frame before the spring.
struct Spring {
  std::string name;
  Matrix6 K = Matrix6::Zero();
  Vector6 theta_0 = Vector6::Zero();
};

/// One elastic coordinate theta along or about an axis, energy 1/2 k theta^2.
struct Compliance {
  Joint joint;
  double stiffness = 0;  ///< N/m or N m/rad, positive
};

/// A point mass fixed in the frame in which it stands: a file's `mass` beside an element follows that
/// element.
struct PointMass {
  double kg = 0;                 ///< positive
  Vector3 at = Vector3::Zero();  ///< m
};

struct Branch;

/// Branches side by side between the frame before and the frame after; all end in the same frame.
struct Group {
  std::vector<Branch> branches;
};

using Element = std::variant<Rigid, AssemblyError, Actuator, Passive, Spring, Compliance, Group, PointMass>;

struct Branch {
  std::string name;
  std::vector<Element> elements;
};

/// From the machine frame to the platform frame: base transform, elements, platform transform, all in
/// `elements`.
using Chain = Branch;

enum class ToolMaterial { carbide, steel };

/// Where the stiffness of a tool at its tip is from: there is none, a radial stiffness, a 6x6 matrix, or the
/// cantilever that its diameter and stick-out make.
enum class ToolStiffness { rigid, radial, matrix, cantilever };

/// What the machine file says of a tool, and how its tip yields.
struct Tool {
  std::optional<double>
      length{};  ///< m: what G43 H adds to Z; from [spindle] to the tip, where that is given
  std::optional<double> diameter{};  ///< m
  std::optional<double> stickout{};  ///< m
  std::optional<double> flute{};     ///< m: from the tip to the end of the cutting edges, along the axis
  ToolMaterial material = ToolMaterial::carbide;
  ToolStiffness from = ToolStiffness::rigid;
  std::vector<Element> yields{};  ///< from the rigid tool's tip to the tip, in the tip's axes; empty: rigid
  bool in_file = true;            ///< else all that is known of it is the length, from a tool table
};

/// Components of the tip pose, in the order of six-vectors.
enum class Component : int { x, y, z, rx, ry, rz };

/// How a work offset was found: its true pose, or by touching the part with the imperfect machine. A datum
/// that is not stated counts as the true pose.
struct Datum {
  std::optional<Vector3> touched_at{};  ///< program coordinates (m)
  bool is_machine = false;              ///< stated: the offset is the true pose

  bool stated() const { return is_machine || touched_at.has_value(); }
};

struct WorkOffset {
  Pose X_MW;
  Datum datum;
};

/// How the control reads programs, where neither the program nor a flag says.
struct ControlSettings {
  std::string dialect = "auto";
  std::string units;                                          ///< "mm", "inch" or empty: not known
  std::optional<std::vector<std::string>> tool_change_moves;  ///< axes; none: all
  bool absolute_centres = false;                              ///< of arcs, until a program says otherwise
};

/// What pulls at masses, and when the controller's zero was set.
struct Gravity {
  Vector3 g = Vector3::Zero();  ///< m/s2, axes of M; zero: no weights act
  bool true_at_home = false;    ///< the zero was set under the machine's own weight at home, not unloaded
  Location reference_at;        ///< where the file says so
};

struct Machine {
  std::string name;
  std::vector<Component> controlled;       ///< as many as there are actuators, or none
  std::optional<Pose> home_X_MP;           ///< required for more than one chain
  Location home_at;                        ///< where the file says home: [home], or else the first chain
  Pose X_PT;                               ///< tool tip in the platform frame
  Location tool_at;                        ///< [tool] in the file; without it the file alone
  bool allows_inverted_tool = false;       ///< the tip's z may point into the work
  std::map<std::string, WorkOffset> work;  ///< by names that `work_offset_name` gives
  bool work_is_machine_frame = false;      ///< stated: program coordinates are M; `work` is empty
  std::optional<Pose> X_PS;    ///< gauge line that tools' lengths count from, z from tip to spindle
  std::map<long, Tool> tools;  ///< by number
  ControlSettings control;
  Gravity gravity;
  double max_correction = 1e-3;    ///< m
  Vector3 p_EP = Vector3::Zero();  ///< reference point in the frame where the chains end: not zero for a
                                   ///< machine with a tool that yields (m)
  std::vector<Chain> chains;
  std::vector<LoadLimits> load_limits;  ///< by chain; empty: the file gives none
};

/// The machine without its assembly errors.
Machine perfect(const Machine& machine);

/// kg, masses in branches of groups included.
double total_mass(const Branch& branch);
double total_mass(const Machine& machine);

/// Whether weights act on it: there are masses, and something pulls at them.
bool weighs(const Machine& machine);
/// All actuators in their order.
std::vector<Actuator> actuators(const Machine& machine);

/// Names of the actuators for messages, in the same order. On a machine of one chain: "axis X" for the only
/// linear axis along X at home, "axis A" for the only rotary one about X, "axis A1" to "axis A6" for the
/// rotary axes of an arm. On a parallel machine: "chain NAME" for the only actuator of that chain. Else
/// "actuator N", N its number from 1.
std::vector<std::string> actuator_names(const Machine& machine);

/// Whether an actuator turns: a robot's do, and those of a machine with rotary drives.
bool turns_joints(const Machine& machine);

}  // namespace counterflex
