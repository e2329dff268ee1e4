#pragma once
/// Bounds of what happens between the ends of a short line. EQUATIONS.md, section 11, "Short lines".
#include "statics/kernel/batch.hpp"

namespace counterflex::kernel {

/// Loads are measured with moments over the machine's length l, so that all six components are in N.

/// The bounds of a target's cell, without a remainder. `half_edge` in m, `load` in N.
OffsetBounds offset_bounds(const StartCell& cell, double half_edge, double load, double length);

/// A line in a cell.
struct LineSizes {
  double way = 0;          ///< between its ends (m)
  double load_change = 0;  ///< between its ends (N)
  double kink = 0;         ///< largest difference of the load from an even change (N)
  double load = 0;         ///< largest load (N)
  bool crosses = false;    ///< a part of the line is in another cell, whose bounds are used, too
};

/// By how much the command is off its chord while the tip goes straight (m), and the gain of the tip (m/m).
/// Infinite if the tip may not follow the command.
struct ChordBounds {
  double command, gain;
};
ChordBounds chord_bounds(const OffsetBounds& bounds, const LineSizes& line);

}  // namespace counterflex::kernel
