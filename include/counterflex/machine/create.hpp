#pragma once
/// Machine files made from what a shop knows of a machine: commented TOML with every number's source and
/// standard deviation in [parameters]. A number that the shop does not give is a marked prior.
#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/geometry/types.hpp"

namespace counterflex {

enum class MachineKind {
  mill3,
  mill3_table,
  gantry,
  table_ac,
  table_bc,
  robot6r,
  hexapod,
  delta,
  orthoglide
};

/// A kind of machine, and the facts of `MachineFacts` that it uses besides its name.
struct KindOfMachine {
  MachineKind kind;
  std::string_view name;  ///< "mill3-table"
  std::string_view what;  ///< one phrase for lists
  /// Axes whose travel can be given: letters; "L" is a leg or a carriage.
  std::string_view travel;
};
inline constexpr std::array<KindOfMachine, 9> kinds_of_machine = {
    {{MachineKind::mill3, "mill3", "three-axis mill whose tool moves", "XYZ"},
     {MachineKind::mill3_table, "mill3-table", "three-axis mill whose table moves", "XYZ"},
     {MachineKind::gantry, "gantry", "three-axis portal mill or router", "XYZ"},
     {MachineKind::table_ac, "table-ac", "mill with a rotary table C on a swivel A", "XYZAC"},
     {MachineKind::table_bc, "table-bc", "mill with a rotary table C on a swivel B", "XYZBC"},
     {MachineKind::robot6r, "robot6r", "six-axis robot of the list of robots", ""},
     {MachineKind::hexapod, "hexapod", "six legs of variable length", "L"},
     {MachineKind::delta, "delta", "three vertical rails and parallelograms", "L"},
     {MachineKind::orthoglide, "orthoglide", "three orthogonal rails and parallelograms", "L"}}};

/// mm, or degrees of a rotary axis. Of a leg: of its length.
struct AxisRange {
  double min = 0, max = 0;
};

/// The joints of a hexapod's leg: on the base in M, on the platform in P.
struct LegNodes {
  Vector3 base_mm = Vector3::Zero(), platform_mm = Vector3::Zero();
};

/// What a shop knows of a machine. Facts that a kind does not use are ignored.
struct MachineFacts {
  MachineKind kind = MachineKind::mill3;
  std::string name{};                  ///< empty: that of the kind or of the robot
  std::map<char, AxisRange> travel{};  ///< by letter; default: a usual one
  /// XY, YZ, ZX: by how much the angles exceed 90 degrees. Without a value 90 degrees, as a prior.
  std::array<std::optional<double>, 3> squareness_um_per_m{};
  std::optional<Vector3> tip_stiffness{};  ///< N/m, in the axes of M
  std::optional<Vector3> pivot_mm{};       ///< where the rotary axes of a table cross, in machine axes
  std::string robot{};                     ///< a name of `known_robots`
  std::vector<LegNodes> nodes{};           ///< six, or empty: an example
  std::optional<Vector3> home_mm{};        ///< of a hexapod's platform
  std::optional<double> leg_stiffness{};   ///< N/m: of a leg, a drive or a bar with its drive
  std::optional<double> arm_mm{};          ///< of a delta or orthoglide: bars between their joints
  std::optional<double> radius_mm{};       ///< of a delta: horizontal length of the bars at the centre
};

/// The file's text. Throws `InputError` (ErrorKind::usage) for facts that make no machine: a robot that is
/// not known, an arm that is shorter than the radius, legs without length.
std::string machine_file(const MachineFacts& facts);

/// A robot whose data are built in.
struct KnownRobot {
  std::string name;  ///< "kuka-kr270-r2700-ultra"
  std::string title;
  std::string lengths, stiffness, masses;  ///< sources; empty: no data
};

/// In the order of src/machine/create/robots.toml.
std::vector<KnownRobot> known_robots();

/// The nodes of a hexapod from a table with the columns base_x_mm, base_y_mm, base_z_mm, platform_x_mm,
/// platform_y_mm and platform_z_mm, and six rows. Cells are separated by commas or semicolons. Throws
/// `InputError` (ErrorKind::machine_or_force) with line and column.
std::vector<LegNodes> read_leg_nodes(std::string_view text, const std::string& file);

}  // namespace counterflex
