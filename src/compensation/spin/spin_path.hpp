#pragma once
/// The best turns along stops of a path, each of a grid.
#include <cstddef>
#include <vector>

#include "counterflex/geometry/types.hpp"

namespace counterflex {

// A finer grid gains little: the deviation changes slowly with the turn.
inline constexpr double spin_step = 5 * deg;
inline constexpr int spin_count = 37;  ///< from -90 to 90 degrees
inline constexpr int spin_zero = 18;   ///< as programmed

/// Feed path for one step of the grid, at least (m). A change of the turn counts as much as the same turn
/// along this way. Of three programs for an arm, whose largest deviations are 2.3 to 2.7 mm: with 5 mm one is
/// 2 µm lower, with 20 mm two are 2 and 4 µm higher.
inline constexpr double between_stops = 10 * mm;

/// A turn is taken only if it gains this share of the largest deviation. Of the same programs, 0.003: 3 µm
/// lower; 0.03: 16 to 25 µm higher.
inline constexpr double least_spin_gain = 0.01;

/// A place on the way to a stop.
struct SpinPlace {
  double fraction = 1;  ///< of the way, from the stop before
  double weight = 0;    ///< feed path (m); 0: the deviation does not count, but the place must be reached
};

/// Where the turn is one of the grid. Between two linked stops it changes evenly.
struct SpinStop {
  bool linked = false;         ///< to the stop before
  bool is_free = false;        ///< else the turn is 0
  int most_steps = 0;          ///< by which the turn may differ from that of the stop before, if linked
  std::size_t places_end = 0;  ///< its places, the last one the stop itself, end here
};

struct SpinGraph {
  std::vector<SpinStop> stops{};
  std::vector<SpinPlace> places{};
  /// By place, then by turn of the grid (m); infinite: the turn is not allowed. At `spin_zero` finite.
  std::vector<float> deviations{};
};

/// Indices of turns by stop: of those with the least largest deviation, within a hundredth of it, those with
/// the least sum of deviation times way and small turns.
std::vector<int> best_turns(const SpinGraph& graph);

/// The largest deviation on the way of these turns (m).
double largest_deviation(const SpinGraph& graph, const std::vector<int>& turns);

}  // namespace counterflex
