#include "program/gcode/words/modal_words.hpp"

#include <algorithm>

#include "program/gcode/moves/contour.hpp"
#include "program/gcode/moves/read_move.hpp"
#include "program/gcode/remarks.hpp"

namespace counterflex {
namespace {

void mark_known(ModalState& state, UnknownMode doubt) {
  state.unknown_modes &= static_cast<std::uint16_t>(~doubt);
}

void apply_unit(Reading& r) {
  if (!r.sorted.has(Action::inches) && !r.sorted.has(Action::millimetres)) return;
  r.state.unit = r.sorted.has(Action::inches) ? LengthUnit::inches : LengthUnit::millimetres;
  mark_known(r.state, unknown_unit);
}

void apply_feed_mode(Reading& r) {
  FeedUnit mode = r.state.feed_mode;
  if (r.sorted.has(Action::feed_per_minute)) {
    mode = FeedUnit::per_minute;
  } else if (r.sorted.has(Action::feed_per_turn)) {
    mode = FeedUnit::per_turn;
  } else if (r.sorted.has(Action::inverse_time)) {
    mode = FeedUnit::inverse_time;
  } else {
    return;
  }
  if (mode != r.state.feed_mode || r.dialect.feed_mode_ends_feed) r.state.feed = 0;
  r.state.feed_mode = mode;
  mark_known(r.state, unknown_feed_mode);
}

void apply_f(Reading& r, std::optional<LengthUnit> unit_before) {
  const Word* f = r.sorted.word('F');
  // On some controls the F of a dwell is a time.
  if (f == nullptr || r.sorted.has(Action::dwell)) return;
  r.state.feed = f->value;
  r.state.feed_unit = r.dialect.feed_before_unit && unit_before ? unit_before : r.state.unit;
}

/// M61 Q2 states the tool in the spindle. The machine does not move.
void state_tool(Reading& r) {
  const bool states = std::ranges::any_of(r.sorted.m, [](const FoundM& m) { return m.code == 61; });
  const Word* q = states ? r.sorted.word('Q') : nullptr;
  if (q == nullptr) return;
  r.state.tool = count_of(*q);
  mark_known(r.state, unknown_tool);
}

void apply_tool(Reading& r) {
  state_tool(r);
  if (const Word* t = r.sorted.word('T')) r.state.tool_chosen = count_of(*t);
  if (!r.sorted.has(MAction::tool_change)) return;
  r.state.tool = r.state.tool_chosen.value_or(0);
  if (r.state.tool_chosen)
    mark_known(r.state, unknown_tool);
  else
    r.state.unknown_modes |= unknown_tool;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (r.tool_change_axes[axis]) move_by_machine(r, axis);
  end_contour(r);
  r.run_begin = r.program.moves.size();
}

void apply_plane(Reading& r) {
  const FoundG* plane = r.sorted.find(Action::plane);
  if (plane == nullptr) return;
  r.state.normal = (190 - plane->code->tenths) / 10;
  mark_known(r.state, unknown_plane);
}

void apply_distance(Reading& r) {
  if (r.sorted.has(Action::relative) || r.sorted.has(Action::absolute)) {
    r.state.relative = r.sorted.has(Action::relative);
    mark_known(r.state, unknown_distance);
  }
  if (r.sorted.has(Action::relative_centres) || r.sorted.has(Action::absolute_centres)) {
    r.state.absolute_centres = r.sorted.has(Action::absolute_centres);
    mark_known(r.state, unknown_centres);
  }
  if (r.sorted.has(Action::initial_level) || r.sorted.has(Action::retract_level)) {
    r.state.returns_to_retract = r.sorted.has(Action::retract_level);
    r.state.level_is_stated = true;
    mark_known(r.state, unknown_level);
  }
}

void apply_path_mode(const Block& block, Reading& r) {
  if (r.sorted.has(Action::g61)) r.state.exact_stop = r.dialect.g61_is_exact_stop;
  if (r.sorted.has(Action::exact_stop)) r.state.exact_stop = true;
  if (r.sorted.has(Action::blend)) r.state.exact_stop = false;
  remark_path_mode(block, r);
}

/// The motion that a code starts; empty if it starts no motion.
std::optional<MotionMode> motion_of(const FoundG& g) {
  switch (g.code->action) {
    case Action::rapid:
      return MotionMode::rapid;
    case Action::feed:
      return MotionMode::feed;
    case Action::arc:
      return g.code->tenths == 20 ? MotionMode::clockwise : MotionMode::counter_clockwise;
    case Action::cycle:
      return MotionMode::cycle;
    case Action::spline:
      return MotionMode::spline;
    case Action::thread:
      return MotionMode::thread;
    case Action::probe:
      // G31 acts in its own block only.
      return g.code->group == CodeGroup::motion ? std::optional(MotionMode::probe) : std::nullopt;
    default:
      return std::nullopt;
  }
}

void set_motion(ModalState& state, MotionMode motion) {
  if (state.motion == MotionMode::cycle && motion != MotionMode::cycle) state.cycle = {};
  state.motion = motion;
  mark_known(state, unknown_motion);
}

}  // namespace

void apply_motion(Reading& r) {
  if (r.sorted.has(Action::end_motion))
    set_motion(r.state, r.dialect.motion_ends_with_g80 ? MotionMode::cancelled : MotionMode::rapid);
  for (const FoundG& g : r.sorted.g)
    if (const auto motion = motion_of(g)) set_motion(r.state, *motion);
}

void apply_feed_and_tool(Reading& r) {
  const std::optional<LengthUnit> unit_before = r.state.unit;
  apply_unit(r);
  apply_feed_mode(r);
  apply_f(r, unit_before);
  // On some controls the S of a dwell is a number of turns.
  const bool gives_speed = !r.sorted.has(Action::dwell) && !r.sorted.has(Action::limits);
  if (const Word* s = r.sorted.word('S'); s != nullptr && gives_speed) r.state.spindle_rpm = s->value;
  if (r.sorted.has(Action::surface_speed)) r.state.spindle_rpm = 0;
  apply_tool(r);
}

void apply_modes(const Block& block, Reading& r) {
  apply_plane(r);
  apply_distance(r);
  apply_path_mode(block, r);
  apply_motion(r);
}

}  // namespace counterflex
