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

/// G70 or G71, not G700 or G710.
bool sets_unit_of_lengths(const SortedBlock& sorted) {
  return std::ranges::any_of(sorted.g,
                             [](const FoundG& g) { return g.code->tenths == 700 || g.code->tenths == 710; });
}

void apply_unit(Reading& r) {
  if (!r.sorted.has(Action::inches) && !r.sorted.has(Action::millimetres)) return;
  r.state.unit = r.sorted.has(Action::inches) ? LengthUnit::inches : LengthUnit::millimetres;
  r.state.unit_is_of_lengths = r.dialect.sinumerik_words && sets_unit_of_lengths(r.sorted);
  mark_known(r.state, unknown_unit);
}

/// G96 and G97 of a Sinumerik have the feed of G95, G961 and G971 that of G94.
std::optional<FeedUnit> feed_mode_of_speed(const Reading& r) {
  if (!r.dialect.sinumerik_words) return std::nullopt;
  for (const FoundG& g : r.sorted.g) {
    const int tenths = g.code->tenths;
    if (tenths == 960 || tenths == 970 || tenths == 9730) return FeedUnit::per_turn;
    if (tenths == 9610 || tenths == 9710) return FeedUnit::per_minute;
  }
  return std::nullopt;
}

void apply_feed_mode(Reading& r) {
  FeedUnit mode = r.state.feed_mode;
  if (r.sorted.has(Action::feed_per_minute)) {
    mode = FeedUnit::per_minute;
  } else if (r.sorted.has(Action::feed_per_turn)) {
    mode = FeedUnit::per_turn;
  } else if (r.sorted.has(Action::inverse_time)) {
    mode = FeedUnit::inverse_time;
  } else if (const auto of_speed = feed_mode_of_speed(r)) {
    mode = *of_speed;
  } else {
    return;
  }
  if (mode != r.state.feed_mode || r.dialect.feed_mode_ends_feed) r.state.feed = 0;
  r.state.feed_mode = mode;
  mark_known(r.state, unknown_feed_mode);
}

/// Whether F may be a lead, or its change: in threads of controls other than LinuxCNC.
bool may_be_lead(const Reading& r) {
  const SortedBlock& sorted = r.sorted;
  if ((r.dialect.family & (linuxcnc_family | grbl_family)) != 0) return false;
  const bool other = sorted.has(Action::rapid) || sorted.has(Action::feed) || sorted.has(Action::arc) ||
                     sorted.has(Action::cycle) || sorted.has(Action::end_motion);
  return sorted.has(Action::thread) || (r.state.motion == MotionMode::thread && !other);
}

void apply_f(Reading& r, std::optional<LengthUnit> unit_before) {
  const Word* f = r.sorted.word('F');
  // On some controls the F of a dwell is a time.
  if (f == nullptr || r.sorted.has(Action::dwell)) return;
  if (may_be_lead(r)) return set_feed(r, 0, r.state.feed_unit);
  set_feed(r, f->value, r.dialect.feed_before_unit && unit_before ? unit_before : unit_of_feed(r));
}

/// S beside G92 is the highest speed on some shop controls.
bool may_limit_speed(const Reading& r) {
  const auto is_g92 = [](const FoundG& g) { return g.code->tenths == 920; };
  return r.dialect.macro_words && std::ranges::any_of(r.sorted.g, is_g92);
}

/// G97, and any code of the feed on a Sinumerik.
bool ends_cutting_speed(const SortedBlock& sorted, const Dialect& dialect) {
  const bool feed = sorted.has(Action::feed_per_minute) || sorted.has(Action::feed_per_turn) ||
                    sorted.has(Action::inverse_time);
  return sorted.has(Action::spindle_speed) || (dialect.sinumerik_words && feed);
}

/// Under a cutting speed the speed of the spindle is unknown, and behind it until the next S.
void apply_s(Reading& r) {
  ModalState& state = r.state;
  if (r.sorted.has(Action::surface_speed)) state.surface_speed = true;
  if (ends_cutting_speed(r.sorted, r.dialect)) state.surface_speed = false;
  const Word* s = r.sorted.word('S');
  // On some controls the S of a dwell is a number of turns.
  if (s != nullptr && !r.sorted.has(Action::dwell) && !r.sorted.has(Action::limits))
    state.spindle_rpm = may_limit_speed(r) ? 0 : s->value;
  if (state.surface_speed) state.spindle_rpm = 0;
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

std::optional<LengthUnit> unit_of_feed(const Reading& r) {
  if (!r.state.unit_is_of_lengths) return r.state.unit;
  if (r.options.unit) return r.options.unit;
  return r.state.unit == LengthUnit::millimetres ? r.state.unit : std::nullopt;
}

void set_feed(Reading& r, double value, std::optional<LengthUnit> unit) {
  r.state.feed = r.state.unit_is_of_lengths && !unit ? 0 : value;
  r.state.feed_unit = unit;
}

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
  if (r.sorted.has(Action::call)) return;  // F, S and T of G65 are arguments
  apply_f(r, unit_before);
  apply_s(r);
  apply_tool(r);
}

void apply_modes(const Block& block, Reading& r) {
  apply_plane(r);
  apply_distance(r);
  apply_path_mode(block, r);
  apply_motion(r);
}

}  // namespace counterflex
