// Blocks that a jump, a repetition or '/' may skip.
#include <algorithm>

#include "program/klartext/read.hpp"

namespace counterflex {
namespace {

void mark_axes_unknown(const KlartextState& before, KlartextState& now) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    const bool same = before.known[axis] && before.position_mm[i] == now.position_mm[i];
    now.known[axis] = now.known[axis] && same;
  }
}

/// The tool, its feeds and its speed; 0 is unknown.
void mark_tool_unknown(const KlartextState& before, KlartextState& now) {
  if (now.tool != before.tool) now.tool = 0;
  now.tool_along_z = now.tool_along_z && before.tool_along_z;
  if (now.feed != before.feed) now.feed = {};
  if (now.tool_feed != before.tool_feed) now.tool_feed = {};
  if (now.feed_per_turn != before.feed_per_turn) now.feed_per_turn.reset();
  if (now.spindle_rpm != before.spindle_rpm) now.spindle_rpm = 0;
  now.plunges_slower = now.plunges_slower || before.plunges_slower;
  now.spindle_off = now.spindle_off || before.spindle_off;
}

/// The next polar coordinates must not be relative to those of the block.
void mark_polar_unknown(const KlartextState& before, KlartextState& now) {
  if (!now.pole) return;
  if (!before.pole || before.pole->radius_mm != now.pole->radius_mm) now.pole->radius_mm.reset();
  if (!before.pole || before.pole->angle != now.pole->angle) now.pole->angle.reset();
}

/// Moves behind the block may call a cycle. If the calls themselves are doubtful, the height is unknown.
void mark_cycle_unknown(const KlartextState& before, KlartextState& now) {
  now.cycle_acts_here = now.cycle_acts_here && before.cycle_acts_here;
  if (now.calls_each == before.calls_each) return;
  now.calls_each = true;
  now.cycle_is_relative = now.takes_surface = false;
  now.surface.reset();
}

/// Moves behind the block may belong to a contour. Its side is unknown.
void mark_contour_unknown(const KlartextState& before, KlartextState& now) {
  if (now.contour == before.contour) return;
  now.contour = true;
  now.beside_contour = false;
  now.cutter_side = CutterSide::none;
}

}  // namespace

void mark_changes_unknown(const KlartextState& before, KlartextState& now) {
  mark_axes_unknown(before, now);
  mark_tool_unknown(before, now);
  mark_polar_unknown(before, now);
  mark_cycle_unknown(before, now);
  mark_contour_unknown(before, now);
  now.basic_rotation_deleted = now.basic_rotation_deleted && before.basic_rotation_deleted;
  now.displacements.insert(before.displacements.begin(), before.displacements.end());
  for (std::size_t axis = 0; axis < now.unfollowed_shift.size(); ++axis)
    now.unfollowed_shift[axis] = now.unfollowed_shift[axis] || before.unfollowed_shift[axis];
}

}  // namespace counterflex
