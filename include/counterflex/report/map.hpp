#pragma once
/// Stiffness or deviation of a machine over its workspace: where a part is cut best. SI inside; mm, N/um and
/// um in the outputs. Places are of the tip, in the machine frame M.
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/statics/equilibrium.hpp"

namespace counterflex {

/// A box with its sides along the axes of M (m). A side may be zero.
struct MapBox {
  Vector3 least = Vector3::Zero(), most = Vector3::Zero();
};

/// Places at even distances in a box, its faces included; a single place of a side is in its middle.
struct MapGrid {
  MapBox box;
  std::array<int, 3> count{1, 1, 1};

  std::size_t size() const;
  /// The place of an index: x runs fastest, then y, then z.
  Vector3 place(std::size_t index) const;
  double coordinate(int axis, int step) const;
  /// Distance of neighbours along an axis; the length of the side where it has a single place.
  double spacing(int axis) const;
};

/// The grid of `box` with a single place along sides of length zero.
MapGrid grid_of(const MapBox& box, const std::array<int, 3>& count);

/// The places that a machine of three linear axes with limits reaches, its other actuators at home. Of other
/// machines: a box around home whose corners are reached, to a whole mm. Its sides are in the proportion of
/// the straight ways from home along x, y and z to where they end, up to these ends. Empty if a way has no
/// end.
std::optional<MapBox> reached_box(const Model& model);

enum class MapQuantity {
  stiffness,  ///< of the tip (N/m): force over motion
  deviation   ///< of the tip's position (m): actual minus commanded
};

struct MapRequest {
  MapQuantity quantity = MapQuantity::stiffness;
  std::optional<Vector3> direction;      ///< stiffness: along this unit vector; none: the least one
  Load load{};                           ///< at the tip
  Matrix3 R_turn = Matrix3::Identity();  ///< orientation of the tip: R_turn R_home
  MapGrid grid{};
  int threads = 1;
};

struct MapPlace {
  Status status = Status::not_converged;  ///< what follows is meaningful only if `converged`
  /// N/m, or m. Infinite: the machine is rigid.
  double value = 0;
  /// Of least stiffness: its direction, a unit vector, the largest component positive. Of a deviation: its
  /// components (m). Axes of M.
  Vector3 vector = Vector3::Zero();
};

/// Values at all places of a grid, in the order of `MapGrid::place`. A value depends on the model, the place
/// and the load only. Stiffness and deviation are those of `analyze_pose`; places outside travel have
/// no value.
std::vector<MapPlace> map_places(const Model& model, const MapRequest& request);

/// How much the mean value over a box of a program changes if the part is moved.
struct MapShift {
  Vector3 shift = Vector3::Zero();  ///< of the part (m, axes of M)
  /// Mean deviation (m), or force over mean motion (N/m).
  double value = 0;
};

/// Where a program is in a map.
struct MappedProgram {
  std::string name;
  MapBox box;                        ///< of its feed moves
  std::optional<double> present;     ///< mean value; none: the box is not within solved places
  std::optional<MapShift> in_plane;  ///< the best shift along x and y; none: no position is solved
  std::optional<MapShift> best;      ///< along x, y and z
};

/// The mean over a box is that of its points at fifths of its sides, interpolated in the grid. Shifts put the
/// lower sides of the box on places of the grid, or its upper sides on the last ones.
MappedProgram place_program(const MapRequest& request, const std::vector<MapPlace>& places,
                            const std::string& name, const MapBox& box);

struct WorkspaceMap {
  std::string version;  ///< of counterflex
  std::string machine;
  std::string tool;               ///< in the spindle, and its stiffness; empty: [tool]
  std::string unmeasured;         ///< "UNMEASURED: ..."; empty unless no stiffness of the machine is measured
  bool weighs = false;            ///< the machine's own weight acts, too
  Vector3 rpy = Vector3::Zero();  ///< of `MapRequest::R_turn` (rad)
  MapRequest request;
  std::vector<MapPlace> places;
  std::optional<MappedProgram> program;
};

/// Indices of the places with the best and the worst value, the first of those that differ by rounding only,
/// and the middle of all. Best: the largest stiffness, the least deviation.
struct MapRange {
  std::size_t solved = 0, rigid = 0;  ///< rigid ones are solved, and have no number
  std::size_t best = 0, worst = 0;    ///< meaningful if solved > rigid
  double median = 0;
};
MapRange range_of(const WorkspaceMap& map);

/// "20 outside_travel, 3 unreachable": the number of places by why they have no value. Empty without one.
std::string unsolved_text(const WorkspaceMap& map);

/// Best and worst place, and the range of each layer of the grid. At most 100 columns wide.
std::string to_text(const WorkspaceMap& map);

/// "counterflex-map 1" (programs/guide/map.md), with all places.
std::string to_json(const WorkspaceMap& map);

/// How the tables begin.
inline constexpr std::string_view map_table_mark = "x_mm,y_mm,z_mm,status,";

/// A row for each place. Places without a value have empty cells.
std::string to_csv(const WorkspaceMap& map);

/// In the title of each picture.
inline constexpr std::string_view map_picture_mark = "Map of the workspace";

/// SVG: a panel for each layer of the grid, y over x.
std::string map_picture(const WorkspaceMap& map);

}  // namespace counterflex
