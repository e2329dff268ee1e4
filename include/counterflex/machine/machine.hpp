#pragma once
/// A machine as data: the values of `machine.toml`, checked, in SI units. A machine is a base, a platform and
/// chains of elements between them; each element is a transform from the frame before it to the frame after
/// it. Frames: machine M (the base), platform P (its origin is the reference point), tool tip T, work frame
/// W.
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "counterflex/files/input_error.hpp"
#include "counterflex/geometry/pose.hpp"
#include "counterflex/geometry/turn.hpp"

namespace counterflex {

// The load limits of joints, springs and ends of chains, as a machine file gives them, and the names of the
// kinds of load.

/// Of one chain; largest absolute components, as `ChainLoads` has them.
enum class LoadKind : std::uint8_t {
  moment,              ///< that the platform exerts on the chain's end
  spring_translation,  ///< of springs and prismatic compliances
  spring_rotation,     ///< of springs and revolute compliances
  spring_force,
  spring_torque,
  group_moment,    ///< that branches side by side transmit at their common end
  passive_change,  ///< of a revolute passive joint's angle from its nominal value
};
inline constexpr std::size_t load_kind_count = static_cast<std::size_t>(LoadKind::passive_change) + 1;
inline constexpr std::array<LoadKind, load_kind_count> load_kinds = {
    LoadKind::moment,        LoadKind::spring_translation, LoadKind::spring_rotation, LoadKind::spring_force,
    LoadKind::spring_torque, LoadKind::group_moment,       LoadKind::passive_change};

/// How files and people name a kind of load.
struct LoadName {
  std::string_view key;    ///< "moment_max_Nm": in machine files and JSON documents
  std::string_view words;  ///< "moment at the end"
  std::string_view unit;   ///< of the key's values: "N m"
  double si = 1;           ///< that unit in SI
};
const LoadName& name_of(LoadKind kind);

/// SI, positive; none: no limit is known.
struct LoadLimits {
  std::array<std::optional<double>, load_kind_count> most{};

  std::optional<double>& operator[](LoadKind kind) { return most[static_cast<std::size_t>(kind)]; }
  const std::optional<double>& operator[](LoadKind kind) const {
    return most[static_cast<std::size_t>(kind)];
  }
  bool operator==(const LoadLimits&) const = default;
};

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

/// How the control shows the value of an actuator: shown = sign value + zero + the sum of the coupled shown
/// values, each times its factor.
struct ShownValue {
  struct Coupling {
    std::size_t actuator = 0;  ///< index of an earlier actuator
    double factor = 0;
  };
  double sign = 1;
  double zero = 0;  ///< m or rad
  std::vector<Coupling> coupled{};
};

/// Errors of the motion of one axis as functions of its shown position, as ISO 230-1 defines them: what the
/// frame behind the actuator is off by, actual minus commanded. Axes of the frame before the actuator; the
/// rotation is about the origin of the frame behind it.
struct ErrorTable {
  std::string name;
  std::vector<double> positions{};  ///< shown values, increasing, two or more (m or rad)
  std::vector<Vector6> errors{};    ///< there: translation (m), rotation vector (rad)
  /// Standard deviation of the error along or about the axis at each position (m or rad). These errors are
  /// parameters only if it is stated.
  std::optional<double> sigma{};
};

/// How many numbered actuators a machine may have.
inline constexpr std::size_t most_actuators = 64;

/// A joint whose value is commanded. Actuators are numbered in the order of chains, then of elements (a
/// group's branches in order, at the place of the group). An actuator with a `program_axis` has no number:
/// the program gives its value, which is constant along a program, and it is a fixed transform at `home`.
struct Actuator {
  Joint joint;
  double min = -std::numeric_limits<double>::infinity();  ///< travel, of the shown value
  double max = std::numeric_limits<double>::infinity();
  double home = 0;       ///< where inverse kinematics starts; of the joint, not the shown value
  int program_axis = 0;  ///< 1 to 6: the external axis E1 to E6 of the program; 0: none
  ShownValue shown{};
  std::optional<ErrorTable> errors{};
  /// Lost motion, not negative (m or rad): the joint lags behind its value by half of it, against the
  /// direction in which it moves.
  std::optional<double> reversal{};
  /// Of a rotary actuator that shows q (without coupled values) and turns by
  /// q + a1 sin q + b1 cos q + a2 sin 2q + b2 cos 2q: a1, b1, a2, b2 (rad). Empty, two or four numbers; not
  /// together with `errors`.
  std::vector<double> harmonics{};
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

/// The stiffness of a joint above a load: gears are softer where few teeth carry.
struct SecondSlope {
  double knee = 0;       ///< N or N m, positive: the load of either sign at which the slope changes
  double stiffness = 0;  ///< of larger loads, positive
};

/// One elastic coordinate theta along or about an axis, energy 1/2 k theta^2; with a second slope that of
/// EQUATIONS.md, section 13.
struct Compliance {
  Joint joint;
  double stiffness = 0;  ///< N/m or N m/rad, positive; with a second slope that below its knee
  std::string name{};    ///< of its parameter; may be empty
  std::optional<SecondSlope> beyond{};
};

/// A point mass fixed in the frame at its place in the chain: a file's `mass` beside an element follows that
/// element.
struct PointMass {
  double kg = 0;                 ///< positive
  Vector3 at = Vector3::Zero();  ///< m
  std::string name{};            ///< of its parameter; may be empty
  bool is_of_tool = false;       ///< of [tools], in the place of that of [tool]: it has no parameter
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

/// The source of a tool's stiffness at its tip: no source (rigid), a radial stiffness, a 6x6 matrix, or the
/// cantilever that its diameter and stick-out make.
enum class ToolStiffness { rigid, radial, matrix, cantilever };

/// The data of a tool in the machine file, and how its tip deflects.
struct Tool {
  /// What G43 H adds to Z (m): from [spindle] to the tip, where that is given.
  std::optional<double> length{};
  std::optional<double> diameter{};  ///< m
  std::optional<double> stickout{};  ///< m
  std::optional<double> flute{};     ///< m: from the tip to the end of the cutting edges, along the axis
  ToolMaterial material = ToolMaterial::carbide;
  ToolStiffness from = ToolStiffness::rigid;
  std::vector<Element> yields{};    ///< from the rigid tool's tip to the tip, in the tip's axes; empty: rigid
  std::optional<PointMass> mass{};  ///< of tool and holder, its place from the tip in the tip's axes
  bool in_file = true;              ///< else all that is known of it is the length, from a tool table
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
  /// The numbers of the offset on the control, X, Y, Z (m): where they are known, a guard compares them.
  std::optional<Vector3> shown{};
};

/// How the control reads programs, where neither the program nor a flag defines it.
struct ControlSettings {
  std::string dialect = "auto";
  std::string units;                                          ///< "mm", "inch" or empty: not known
  std::optional<std::vector<std::string>> tool_change_moves;  ///< axes; none: as the dialect has it
  bool absolute_centres = false;                              ///< of arcs, until a program changes it
  /// Called programs that neither move the machine nor change its state; in upper case without blanks.
  std::set<std::string, std::less<>> harmless_calls{};
};

/// The link lengths with which the control computes the joint values of a target.
enum class ControlKinematics {
  unstated,
  catalogue,  ///< the nominal lengths
  factory,    ///< lengths that the maker calibrated: the file's errors are what these leave
};

/// What a control may correct by itself.
enum class Corrected : std::uint8_t { error_tables, reversal, gravity };
inline constexpr std::array<std::string_view, 3> corrected_names = {"error_tables", "reversal", "gravity"};

/// The source of a number.
enum class NumberSource { measured, catalogue, prior };

/// What a machine file states about one of its parameters (machine/parameters.hpp).
struct ParameterStatement {
  std::string name;
  NumberSource source = NumberSource::prior;
  std::optional<double> sigma{};  ///< standard deviation, SI
  std::string note{};             ///< where the number is from
};

/// Parameters (machine/parameters.hpp) with their covariance (SI).
struct KnownParameters {
  std::vector<std::string> names;
  Eigen::MatrixXd covariance;
};

/// Standard deviations of what a run assumes, besides those of parameters in `ParameterStatement`.
struct Uncertainty {
  std::string covariance{};  ///< path of the file with the parameters' covariance, as given; empty: none
  Location covariance_at{};  ///< in the file
  std::optional<KnownParameters> known{};  ///< of that file; the caller of `read_machine` reads it
  double force = 0.3;         ///< of the wrench on the tool, a share of it; one for the whole path
  double tool_length = 0;     ///< m: along the tool's axis
  double repeatability = 0;   ///< m: of the tip along each axis of M, independent from place to place
  double temperature = 0;     ///< K: of the machine with a thermal table
  Location temperature_at{};  ///< in the file
};

/// What pulls at masses, and when the controller's zero was set.
struct Gravity {
  Vector3 g = Vector3::Zero();  ///< m/s2, axes of M; zero: no weights of the machine act
  /// The same of weights that are hung on the machine: the control does not correct these.
  Vector3 of_hung{0, 0, -9.80665};
  bool true_at_home = false;  ///< the zero was set under the machine's own weight at home, not unloaded
  Location reference_at;      ///< where the file sets `true_at_home`
};

/// A part that deflects with its fixture. It is fixed to M through one spring; the tip's deviation is
/// relative to it.
struct Fixture {
  Pose X_MF;                    ///< F: where the spring is, and its axes
  Matrix6 C = Matrix6::Zero();  ///< of the spring (SI), axes of F, symmetric positive semidefinite
};

/// How the tip of the unloaded machine moves with temperature, as a shop measures it with a probe and a
/// thermometer. Linear between the temperatures.
struct ThermalTable {
  std::vector<double> temperatures{};  ///< degrees Celsius, increasing
  std::vector<Vector3> shift{};        ///< there: of the whole machine against the part, axes of M (m)
  std::vector<double> growth{};        ///< there: of the spindle, from the spindle to the tip (m)
};

struct Machine {
  std::string name;
  std::string serial{};               ///< number of the machine; empty: not stated
  std::string date{};                 ///< of the file's data, "2026-11-20"; empty: not stated
  std::vector<Component> controlled;  ///< as many as there are actuators, or none
  std::optional<Pose> home_X_MP;      ///< required for more than one chain
  Location home_at;                   ///< place of home in the file: [home], or else the first chain
  Pose X_PT;                          ///< tool tip in the platform frame, z from the tip to the spindle
  /// Of the control's tool frame, in which [tool] is given: T in it is `tool_axes(spindle_axis)`.
  SpindleAxis spindle_axis = SpindleAxis::z;
  Location tool_at;                        ///< [tool] in the file; without it the file alone
  bool allows_inverted_tool = false;       ///< the tip's z may point into the work
  std::map<std::string, WorkOffset> work;  ///< by names that `work_offset_name` gives
  bool work_is_machine_frame = false;      ///< stated: program coordinates are M; `work` is empty
  std::optional<Pose> X_PS;    ///< gauge line that tools' lengths count from, z from tip to spindle
  std::map<long, Tool> tools;  ///< by number
  ControlSettings control;
  ControlKinematics kinematics = ControlKinematics::unstated;
  /// What the control corrects by itself. The rest of the machine is without it.
  std::vector<Corrected> already_corrects{};
  /// Stated: shown values of the actuators were compared with the pendant. Only then do the joint values of a
  /// program define places.
  bool joint_values_as_shown = false;
  Gravity gravity;
  double max_correction = 1e-3;  ///< m
  /// Reference point in the frame where the chains end: not zero for a machine with a tool that bends (m).
  Vector3 p_EP = Vector3::Zero();
  std::vector<Chain> chains;
  bool ends_with_tool_mass = false;  ///< the last element of the first chain is the mass of [tool]
  std::optional<Fixture> fixture;
  std::optional<ThermalTable> thermal;
  std::optional<double>
      temperature;  ///< degrees Celsius: that of `at_temperature`; its errors have the shift
  std::vector<LoadLimits> load_limits;         ///< by chain; empty: the file gives none
  std::vector<ParameterStatement> parameters;  ///< in the order of the file
  std::optional<Uncertainty> uncertainty{};    ///< none: results are without bands
};

/// Whether the machine lists the component as controlled.
bool controls(const Machine& machine, Component component);

/// Whether it lists all six.
bool controls_pose(const Machine& machine);

/// The machine without its assembly errors, error tables, harmonics and reversal errors.
Machine perfect(const Machine& machine);

/// What a thermal table gives at a temperature (degrees Celsius) inside of it.
struct ThermalShift {
  Vector3 shift = Vector3::Zero();
  double growth = 0;
};
ThermalShift thermal_shift(const ThermalTable& table, double temperature);

/// The machine at a temperature inside of its thermal table, which it has: shift and growth become errors at
/// the beginning and the end of its chains, in place of those of the temperature that it had.
Machine at_temperature(const Machine& machine, double temperature);

/// The machine without its thermal shift, as it is at the zeros of its table.
Machine without_temperature(const Machine& machine);

/// kg, masses in branches of groups included.
double total_mass(const Branch& branch);
double total_mass(const Machine& machine);

/// Whether weights act on it: there are masses, those of tools included, and something pulls at them.
bool weighs(const Machine& machine);
/// The largest amplitude of the actuator's harmonics (rad); 0 without.
double largest_harmonic(const Actuator& actuator);

/// All numbered actuators in their order.
std::vector<Actuator> actuators(const Machine& machine);

/// Names of the actuators for messages, in the same order. On a machine of one chain: "axis X" for the only
/// linear axis along X at home, "axis A" for the only rotary one about X, "axis A1" to "axis A6" for the
/// rotary axes of an arm. On a parallel machine: "chain NAME" for the only actuator of that chain. Else
/// "actuator N", N its number from 1.
std::vector<std::string> actuator_names(const Machine& machine);

/// Whether an actuator turns: a robot's do, and those of a machine with rotary drives.
bool turns_joints(const Machine& machine);

// Tools that bend: the machine with one of them in its spindle, and what such a tool is.

/// Two compliances along the tip's x and y of stiffness `k` (N/m, positive): axially and in tilt the tool is
/// rigid.
std::vector<Element> radial_tool(double k);

/// The bending of what sticks out of the holder: a cantilever of 0.8 of the diameter, along -z of the tip's
/// axes. `diameter` and `stickout` in m, positive.
///
/// Carbide: E 600 GPa, Poisson's ratio 0.22 (K10 to K20 grades, 6 to 10 % Co: 580 to 630 GPa in makers' data
/// sheets). Steel, HSS too: E 210 GPa, 0.3. The 0.8 is the usual equivalent diameter of a fluted end mill.
/// Source: Kops, Vo, "Determination of the equivalent diameter of an end mill based on its compliance", CIRP
/// Annals 39 (1990).
Spring cantilever_tool(double diameter, double stickout, ToolMaterial material);

/// Force over displacement at the tip (N/m) in the direction of x or y in which it bends most; infinite for
/// a rigid tool.
double radial_stiffness(const Tool& tool);

/// The tool's tip in the platform frame: [spindle] moved by the tool's length along -z; [tool] where one of
/// them is missing.
Pose tip_of(const Machine& machine, const Tool& tool);

/// Whether the machine with this tool is another than the machine with [tool].
bool changes_model(const Machine& machine, const Tool& tool);

/// The machine with `tool` in its spindle: its tip, and its springs as the last elements before it. A machine
/// of several chains becomes one chain that begins with a group of them; actuators keep their numbers, the
/// platform is then the tip.
Machine with_tool(const Machine& machine, const Tool& tool);

/// "stiffness from a carbide cantilever of 0.8 diameter core, 25 mm long: 12.3 N/um at its tip"; what else
/// it is from; "rigid".
std::string stiffness_phrase(const Tool& tool);

// Names of work offsets.

/// The name as programs' offsets have it ("G54", "G59.1", "G54.1 P3" also for "G154 P3", "G505", "UF 5",
/// "BASE_DATA[1]", "$BASE", "$BASE 1", "USER 3"), of one that may be in lower case, lack the blank before P
/// or have zeros before the number. The name of a robot's frame ("table", a work object or a variable) as it
/// is. None for other text.
std::optional<std::string> work_offset_name(std::string_view text);

/// What `work_offset_name` takes, for diagnostics.
inline constexpr std::string_view work_offset_names =
    "G54 to G59, G59.1 to G59.3, G54.1 P1 to P300, G154 P1 to P99, G500 to G599, UF 0 to UF 99, "
    "BASE_DATA[1] to BASE_DATA[99], $BASE, $BASE 1, $NULLFRAME, USER 1 to USER 99 and names of work objects";

}  // namespace counterflex
