#include "counterflex/report/run_tally.hpp"

#include <algorithm>

#include "control.hpp"
#include "counterflex/geometry/units.hpp"

namespace counterflex {

RunTally::RunTally(double min_block_ms) : min_block_ms_(min_block_ms) {}

void RunTally::add_waypoints(const std::vector<Waypoint>& waypoints) {
  for (const Waypoint& w : waypoints) path_.add(w);
}

void RunTally::add_forces(const PathForces& forces) {
  forces_.ramps += forces.ramps();
  forces_.jumps += forces.jumps();
  forces_.largest_step_N = std::max(forces_.largest_step_N, forces.largest_step_N());
  for (const Unforced& move : forces.unforced()) add_unforced(forces_.without, move);
  for (const ForceNote& note : forces.notes()) list(force_notes_, Remark{note.line, note.what});
}

void RunTally::add_compensation(const Compensation& compensation) {
  corrected_moves_ += compensation.corrected_moves;
  other_moves_.grouped += compensation.other_moves.grouped;
  other_moves_.held += compensation.other_moves.held;
  other_moves_.in_part += compensation.other_moves.in_part;
  other_moves_.left += compensation.other_moves.left;
  inserted_blocks_ += compensation.counts.inserted_blocks;
  text_bytes_ += compensation.text.size();
  for (const LeftAlone& block : compensation.left_alone) list(left_alone_, block);
  const double correction_mm = compensation.largest_correction / mm;
  if (largest_correction_.line == 0 || correction_mm > largest_correction_.mm + indistinct_mm)
    largest_correction_ = {correction_mm, compensation.largest_correction_line};
}

void RunTally::add_corrected(const Program& corrected_window) {
  if (!lines_) lines_.emplace();
  if (!short_blocks_) short_blocks_.emplace().limit_ms = min_block_ms_;
  add_lines(*lines_, corrected_window.text, corrected_window.dialect);
  add_short_blocks(*short_blocks_, corrected_window);
}

}  // namespace counterflex
