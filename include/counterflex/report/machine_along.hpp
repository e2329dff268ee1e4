#pragma once
/// The nominal machine along a path, for the page: its axes, its distance from singular poses, its lines.
#include <optional>
#include <string>
#include <vector>

#include "counterflex/compensation/loads_along.hpp"
#include "counterflex/report/kinematics.hpp"
#include "counterflex/sanity/checks.hpp"
#include "counterflex/statics/skeleton.hpp"

namespace counterflex {

struct MachinePlace {
  double s = 0;                     ///< cutting path length (m)
  int line = 0;                     ///< of the original program
  KinematicPlace place;             ///< of the commanded target
  double conditioning = 0;          ///< reciprocal condition of the map from actuators to the tip, 0 to 1
  std::vector<SkeletonLine> lines;  ///< empty if the place is not known
};

/// An axis that the program commands. It has the same value along the whole path.
struct ConstantAxis {
  std::string name;  ///< "E1"
  JointKind kind = JointKind::prismatic;
  double value = 0;  ///< m or rad
};

struct MachineAlong {
  std::vector<Travel> axes;          ///< of the shown values
  std::vector<AxisValues> ranges{};  ///< of `axes` over the whole path, as the tally of a run has them
  std::vector<ConstantAxis> constant;
  std::vector<MachinePlace> places;        ///< in the order of the path
  std::optional<double> least_arm_margin;  ///< rad: a run is refused below it; none: no limit
};

/// The machine at `places`. Joint values are those nearest to the ones before, so that they count on over
/// full turns. `model`: of `machine` without a tool. `starts`, `threads`: as for `solve_loads`.
MachineAlong machine_along(const Machine& machine, const Model& model, const std::vector<LoadPlace>& places,
                           int threads, const StartTables* starts = nullptr);

/// For a page. n: number of places; arrays as in `curves_json`, NaN where a place is not known:
///
///     {"s_mm": float64[n], "line": int32[n],
///      "axes": [{"name", "unit": "mm" or "deg", "min", "max": null without a limit, "least", "largest",
///                "least_margin": of the whole path, null without a limit, "margin_line",
///                "values": float32[n]}],
///      "constant": [{"name", "unit", "value"}],
///      "margins": [{"what", "values": float32[n], deg}], "refused_below_deg": null without a limit or
///      margins,
///      "conditioning": float32[n]; null if there are margins, or if it is the same everywhere,
///      "skeleton": {"every": k, "lines": [[node, ...], ...]}}
///
/// A node has its place (mm, 0.1 mm) as [x, y, z] if it stays, else as float32[3 m]: at each k-th of the n
/// places.
std::string machine_json(const MachineAlong& along);

}  // namespace counterflex
