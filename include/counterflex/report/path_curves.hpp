#pragma once
/// The path in a bounded number of stretches, for curves and pictures: what a plot can show of a program of
/// any length, without losing a peak. Lengths in mm, angles in degrees, as reports show them.
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/compensation/loads_along.hpp"
#include "counterflex/compensation/options.hpp"
#include "counterflex/machine/machine.hpp"

namespace counterflex {

/// What has a curve. Deviations are actual minus wanted, axes of the machine; names end in their unit.
enum class Quantity : std::uint8_t {
  before_x,
  before_y,
  before_z,
  before,  ///< norm
  before_along,
  before_across,
  before_tool_axis,
  before_rotation,
  after_x,
  after_y,
  after_z,
  after,
  after_along,
  after_across,
  after_tool_axis,
  after_rotation,
  geometry_x,
  geometry_y,
  geometry_z,
  geometry,
  load_x,
  load_y,
  load_z,
  load,
  fixture_x,
  fixture_y,
  fixture_z,
  fixture,
  gravity_x,
  gravity_y,
  gravity_z,
  gravity,
  preloads_x,
  preloads_y,
  preloads_z,
  preloads,
  superposition_x,
  superposition_y,
  superposition_z,
  superposition,
  discrepancy_x,  ///< before minus superposition
  discrepancy_y,
  discrepancy_z,
  discrepancy,
  air,
  correction_x,
  correction_y,
  correction_z,
  correction,
  force_x,
  force_y,
  force_z,
  force,
  before_band,  ///< half the width, k = 2
  after_band,
};
inline constexpr std::size_t quantity_count = static_cast<std::size_t>(Quantity::after_band) + 1;

/// "before_x_mm", "before_mm", "before_rotation_deg", "force_N": as the page's data has it.
std::string_view name_of(Quantity quantity);

/// Consecutive waypoints of feed moves.
struct Stretch {
  double s_mm = 0;     ///< cutting path length where it ends
  int first_line = 0;  ///< of the original program, in the order of the path
  int last_line = 0;
  std::int32_t operation = -1;      ///< of its first waypoint, as the caller counts them; -1: not given
  bool begins_after_rapid = false;  ///< a rapid precedes a waypoint of it
  /// At the waypoint with the largest deviation `after` (of a prediction: `before`): the wanted tip, and the
  /// deviations there; NaN where unknown.
  std::array<float, 3> place{}, before{}, after{};
  std::array<float, 3> direction{};  ///< unit vector of the wanted path at its last waypoint; zero if unknown
  std::array<float, quantity_count> least{}, largest{};  ///< NaN where nothing is known
};

/// Places that a plot marks, by cutting path length (mm), in the order of the path: all of them, or evenly
/// thinned out where there are more than `most`.
struct PathMarks {
  static constexpr std::size_t most = 2000;
  std::vector<double> s_mm;
  std::size_t count = 0;  ///< all, with those that were thinned out

  void add(double s);

 private:
  std::size_t stride_ = 1;
};

/// Gathers waypoints in the order of the path. Waypoints that were not solved are ignored. While there
/// are at most `most_stretches` each has a stretch of its own; where there are more, neighbours are merged
/// two by two, again and again, so that memory stays bounded.
class PathCurves {
 public:
  static constexpr std::size_t most_stretches = 8192;

  /// `corrected`: whether there is a corrected program, so that after, correction and air mean something;
  /// `weighs`: whether weights act, so that gravity does; `has_fixture`: whether the machine has one.
  explicit PathCurves(bool corrected, bool weighs = false, bool has_fixture = false);

  /// The next waypoint; `operation` as the caller counts them.
  void add(const Waypoint& w, std::int32_t operation);

  /// A step of the force profile.
  void add_force_step(double s_mm);

  /// All so far, in order; where waypoints were merged the last stretch may have fewer than the others.
  const std::vector<Stretch>& stretches() const { return stretches_; }
  std::size_t waypoints_per_stretch() const {
    return per_stretch_;
  }  ///< a power of two; 1: nothing was merged
  std::size_t waypoints() const { return waypoints_; }
  const PathMarks& rapids() const { return rapids_; }
  const PathMarks& force_steps() const { return force_steps_; }
  bool corrected() const { return known_.corrected; }

  /// Which quantities mean something.
  struct Known {
    bool corrected = false;
    bool weights = false;
    bool fixture = false;
  };

 private:
  void push(const Stretch& stretch);
  void merge_neighbours();
  Quantity picture() const;  ///< whose largest value decides what a stretch shows in space

  Known known_;
  std::vector<Stretch> stretches_;
  std::size_t per_stretch_ = 1, in_last_ = 0, waypoints_ = 0;
  double s_mm_ = 0;  ///< of the last waypoint
  bool after_rapid_ = false;
  PathMarks rapids_, force_steps_;
};

// Loads along a path as a report gives them: the largest of every chain, and how near they come to the limits
// of the machine file. In the units of their keys (N, N m, mm, deg).

/// A load in the unit of its kind's key.
double shown_value(const ChainLoads& loads, LoadKind kind);

/// The largest load of a kind; of equal ones the first.
struct LoadPeak {
  double value = 0;
  int line = 0;  ///< of the original program; 0 where nothing carries such a load
  std::optional<double> limit{};
};

/// How much of a limit is used: above 1 it is exceeded; 0 without a limit.
double share_of_limit(const LoadPeak& peak);

/// By more than rounding.
bool is_exceeded(const LoadPeak& peak);

struct LoadsOfChain {
  std::string name;
  std::array<LoadPeak, load_kind_count> peaks{};

  LoadPeak& operator[](LoadKind kind) { return peaks[static_cast<std::size_t>(kind)]; }
  const LoadPeak& operator[](LoadKind kind) const { return peaks[static_cast<std::size_t>(kind)]; }
};

struct PathLoads {
  LoadsAlong along;
  std::vector<LoadsOfChain> chains;  ///< in the machine's order
};

/// None where no place was solved.
std::optional<PathLoads> path_loads(LoadsAlong along, const Machine& machine);

/// "chain leg: spring force 431.2 N", "its limit of 400 N" where it has one.
std::string load_in_words(const LoadsOfChain& chain, LoadKind kind);
std::string limit_in_words(const LoadsOfChain& chain, LoadKind kind);

/// The loads over the path for a page: an object of lists `s_mm` and `line`, and for each of `chains` its
/// `name` and a list of every kind; "null" without loads. Seven significant digits.
std::string loads_json(const std::optional<PathLoads>& loads);

}  // namespace counterflex
