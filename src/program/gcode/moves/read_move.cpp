#include "program/gcode/moves/read_move.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "counterflex/geometry/curve.hpp"
#include "counterflex/program/kept_words.hpp"
#include "program/expand/expand.hpp"
#include "program/gcode/moves/contour.hpp"
#include "program/gcode/remarks.hpp"
#include "program/gcode/words/modal_words.hpp"

namespace counterflex {
namespace {

bool is_increments(const Reading& r, const Word& word) {
  return !word.point && r.options.integer_words == IntegerWords::increments &&
         r.dialect.integer_words_ambiguous;
}

/// 0 if it is unknown.
double spindle_rpm(const ModalState& state) {
  return state.spindle_off ? 0 : state.spindle_rpm;
}

/// Length of the move's path (mm); 0 if it is unknown.
double way_mm(const Move& move) {
  if (!all_known(move.known_start) || !all_known(move.known_end)) return 0;
  if (!move.arc) return (move.end_mm - move.start_mm).norm();
  const Vector3 normal = normal_of(*move.arc);
  const double sweep =
      sweep_between(move.start_mm, move.end_mm, move.arc->centre_mm, normal, move.arc->turns);
  return length({move.start_mm, move.end_mm, Arc{move.arc->centre_mm, normal, sweep}});
}

/// G93: F applies to this block only.
void set_inverse_time(const Reading& r, Move& move) {
  move.feed_mode = FeedMode::inverse_time;
  const Word* f = r.sorted.word('F');
  if (f == nullptr || !f->literal) return;
  move.feed_per_min = f->value;
  move.feed_mm_min = f->value * way_mm(move);
}

/// Whether the feed is known of a move that is inserted before the block: before a rapid it has no F of its
/// own.
bool jump_has_feed(const Reading& r, const Move& move) {
  return (move.motion == Motion::feed ? move.feed_mm_min : r.feed_before_mm_min) > 0;
}

/// Whether the block has words whose effect inserted points would change.
void allow_changes(const Reading& r, Move& move) {
  const SortedBlock& b = r.sorted;
  const bool feed = move.motion == Motion::feed;
  const bool unit =
      b.has(Action::inches) || b.has(Action::millimetres);  // the unit would change an F copied before it
  const bool tool_length = r.sets_tool_length;
  const bool acts_at_end = b.has(MAction::acts_after) || b.has(MAction::end) || b.has(MAction::tool_change) ||
                           b.has(MAction::retract) || b.has(MAction::machine);
  // Behind a piece that '/' may skip the start of an arc would be unknown.
  const bool skips_arc = move.block_delete && move.arc;
  const bool rigid = r.relative() != r.state.relative || move.handling != Handling::own ||
                     any_axis(move.fixed) || move.cycle.has_value() || skips_arc;
  // Pieces of a G93 move need a share of its time. Pieces would not have the feed of the block alone.
  const bool shares_feed = !r.own_feed && (move.feed_mode != FeedMode::inverse_time || move.feed_per_min > 0);
  // Inserted words and blocks are read in the modal state.
  const bool has_own_modes = r.relative() != r.state.relative;
  // Pieces of a block that only turns the tool get an F per minute.
  const bool turns_per_revolution = r.state.feed_mode == FeedUnit::per_turn && only_turns(move);
  // The control shortens both blocks of a corner. The corner is in one plane.
  const bool corner = r.corner || r.after_corner;
  move.may_insert_words = move.may_insert_words && !tool_length && !any_axis(move.fixed) && !has_own_modes;
  move.may_split = feed && !corner && !rigid && !move.exact_stop && !tool_length && !acts_at_end &&
                   shares_feed && !turns_per_revolution;
  const bool only_motion = b.g.empty() || (b.g.size() == 1 && b.g[0].code->group == CodeGroup::motion);
  move.stays_whole = rigid || !shares_feed || !only_motion || !b.m.empty() || b.has_any("ABCDHLPQSTUVW") ||
                     changes_compensation(r.state);
  move.may_jump = all_known(move.known_start) && !corner && !rigid && jump_has_feed(r, move) &&
                  !move.exact_stop && !acts_at_end && !unit &&
                  (feed ? move.may_split : only_motion && !move.block_delete);
}

std::string_view displacement_text(const Reading& r) {
  const std::uint16_t bits = r.state.displaced;
  if ((bits & rotary) != 0)
    return "a word of A, B, C, U, V or W is not zero: further axes are not supported; write corners as ,C "
           "and ,R";
  if ((bits & tool_point) != 0) return "tool centre point control is active";
  if ((bits & kinematics) != 0) return "the kinematics were switched";
  if ((bits & rotated) != 0) return "coordinates are rotated";
  if ((bits & scaled) != 0) return "coordinates are scaled";
  if ((bits & mirrored) != 0) return "coordinates are mirrored";
  if ((bits & polar) != 0) return "coordinates are polar";
  if ((bits & modal_macro) != 0) return "every move calls a macro; its heights are not corrected";
  if ((bits & framed) != 0) return "a frame shifts or turns coordinates";
  if ((bits & unknown) != 0) return "an unknown code may be active";
  if ((bits & tilted) != 0) return "coordinates are tilted";
  if ((bits & data) != 0)
    return r.dialect.sinumerik_words ? "a variable or a measuring cycle has set the coordinates"
                                     : "G10 has set the work offset";
  if ((bits & shifted) == 0) return "G92 has set the position";
  return r.dialect.sinumerik_words ? "G58 or G59 shifts the coordinates" : "G52 shifts the coordinates";
}

std::string_view unknown_mode_text(std::uint16_t unknown_modes, bool sinumerik) {
  if ((unknown_modes & unknown_unit) != 0)
    return "its unit is unknown (a condition, a call or a '/' block may have set it)";
  if ((unknown_modes & unknown_offset) != 0)
    return "its work offset is unknown (a condition, a call or a '/' block may have set it)";
  if ((unknown_modes & unknown_distance) != 0)
    return "G90 or G91 is unknown (a condition, a call or a '/' block may have set it)";
  if ((unknown_modes & unknown_cutter) != 0)
    return "G41 or G42 is unknown (a condition, a call or a '/' block may have set it)";
  if ((unknown_modes & unknown_feed_mode) != 0)
    return "G93, G94 or G95 is unknown (a condition, a call or a '/' block may have set it)";
  if ((unknown_modes & unknown_tool) != 0)
    return "its tool is unknown (a condition, a call or a '/' block may have changed it)";
  if ((unknown_modes & unknown_motion) != 0 && sinumerik)
    return "its motion is not followed (CIP, CT or a spline), or a condition, a call or a '/' block may have "
           "set it";
  if ((unknown_modes & unknown_motion) != 0)
    return "its motion is unknown (a condition, a call or a '/' block may have set it)";
  if ((unknown_modes & unknown_plane) != 0)
    return "G17, G18 or G19 is unknown (a condition, a call or a '/' block may have set it)";
  if ((unknown_modes & unknown_centres) != 0)
    return "G90.1 or G91.1 is unknown (a condition, a call or a '/' block may have set it)";
  return "G98 or G99 is unknown (a condition, a call or a '/' block may have set it)";
}

/// Whether the only displacement is a macro that every move calls: the moves to its positions are plain.
bool only_calls_macro(const Reading& r) {
  return r.state.displaced == modal_macro && !r.in_body() && r.state.unknown_modes == 0;
}

/// A word whose position is not followed.
void place_unknown(Reading& r, Move& move, std::size_t axis) {
  const bool relative = r.relative() && (r.state.unknown_modes & unknown_distance) == 0;
  move.fixed[axis] = !relative;
  r.state.known[axis] = false;
}

/// The position of a hole in the plane is shifted with the contours. Its heights belong to the macro. The
/// height at which the macro leaves the tool is unknown. Returns whether the macro is called at the position
/// of the word.
bool place_macro_word(Reading& r, Move& move, std::size_t axis, const Word& word) {
  place_unknown(r, move, axis);
  if (!word.literal || r.relative()) return false;
  coordinate(r.state.position_mm, axis) = length_mm(r, word);
  if (axis == 2) return true;
  move.fixed[axis] = false;
  move.words[axis] = AxisWord{word.number, word.decimals};
  return true;
}

bool is_difference(const Reading& r, std::size_t axis) {
  const bool alone = (r.relative_axes >> axis & 1) != 0;
  return alone || (r.relative() && (r.state.unknown_modes & unknown_distance) == 0);
}

/// Whether the word is the first one of its axis behind a change of the frame of a Sinumerik, and a
/// difference: a setting of the control decides whether the axis also travels the change.
bool may_travel_frame(const Reading& r, std::size_t axis) {
  constexpr double none_mm = 1e-9;
  return r.state.known[axis] && is_difference(r, axis) &&
         std::abs(r.state.untravelled_mm[static_cast<Eigen::Index>(axis)]) > none_mm;
}

void place_word(Reading& r, Move& move, std::size_t axis, const Word& word, bool followed) {
  ModalState& state = r.state;
  const bool relative = is_difference(r, axis);
  if (!word.literal || !followed) return place_unknown(r, move, axis);
  if (relative && (!state.known[axis] || may_travel_frame(r, axis))) return fix_axis(r, move, axis);
  coordinate(state.untravelled_mm, axis) = 0;
  move.words[axis] = AxisWord{word.number, word.decimals};
  const double value = length_mm(r, word);
  coordinate(state.position_mm, axis) = relative ? coordinate(state.position_mm, axis) + value : value;
  if (!state.known[axis]) state.known[axis] = true;  // a byte just stored delays the copy of all three
}

/// T in the spindle. If no tool was changed to, the tool whose length is active.
std::int32_t tool_of(const Reading& r) {
  if (r.state.tool > 0) return as_tool(r.state.tool);
  // On a Sinumerik the length belongs to a cutting edge of the tool, D.
  const bool by_length = r.state.tool_length && !r.dialect.sinumerik_words;
  return by_length && *r.state.tool_length <= INT32_MAX ? as_tool(static_cast<long>(*r.state.tool_length))
                                                        : 0;
}

/// On a Sinumerik the length of the tool acts with its edge, D1 unless stated.
bool has_tool_length(const Reading& r) {
  return r.dialect.sinumerik_words ? r.state.tool > 0 : r.state.tool_length.value_or(0) != 0;
}

/// ANG= beside one word of X and Y gives the other coordinate by the direction of the line. False if the
/// block is not followed.
bool place_by_angle(Reading& r, Move& move) {
  constexpr double along = 1e-6;    // the direction is nearly along the axis without a word
  constexpr double across = 1e-12;  // of the axis without a word: the cosine of 90 degrees
  const Word& angle = *r.angle;
  const std::size_t given = move.words[0] ? 0 : 1, other = 1 - given;
  const bool line = r.state.motion == MotionMode::rapid || r.state.motion == MotionMode::feed;
  if (!line || r.state.normal != 2 || !angle.literal || !move.words[given] || move.words[other] ||
      !r.state.known[0] || !r.state.known[1])
    return false;
  const double radians = angle.value * std::numbers::pi / 180;
  const double direction[2] = {std::cos(radians), std::sin(radians)};
  if (std::abs(direction[given]) < along) return false;
  const double way = coordinate(r.state.position_mm, given) - move.start_mm[static_cast<Eigen::Index>(given)];
  if (std::abs(direction[other]) > across)
    coordinate(r.state.position_mm, other) += way * direction[other] / direction[given];
  move.words[other] = AxisWord{angle.number, 0};
  move.angle_axis = other == 0 ? 1 : 2;
  return true;
}

}  // namespace

bool may_turn_tool(const Reading& r) {
  return r.options.tool_orientation && r.dialect.family == linuxcnc_family;
}

namespace {

constexpr std::string_view letters_of_angles = "ABC";

/// Reads A, B and C. Under G91 and where the block is not followed the angle is unknown.
void place_angles(const Block& block, Reading& r, Move& move, bool followed) {
  ModalState& state = r.state;
  MoveOrientation orientation{.by_angles = true, .spindle_axis = r.options.spindle_axis};
  const bool starts_known = state.turns_tool && all_known(state.known_angles);
  for (std::size_t i = 0; i < 3; ++i) {
    orientation.start[i] = coordinate(state.angles_deg, i);
    if (const Word* word = r.sorted.word(letters_of_angles[i])) {
      state.turns_tool = true;
      state.known_angles[i] = followed && word->literal && !r.relative();
      if (state.known_angles[i]) orientation.words[i] = AxisWord{word->number, word->decimals};
      coordinate(state.angles_deg, i) = word->value;
    }
    orientation.end[i] = coordinate(state.angles_deg, i);
  }
  if (!state.turns_tool) return;
  if (!starts_known) move.known_start.fill(false);
  if (all_known(state.known_angles))
    move.orientation = orientation;
  else
    note_uncorrected(block, r,
                     "the tool's orientation is not known: program A, B and C with plain numbers under G90");
}

}  // namespace

const Word& first_axis_word(const Block& block) {
  for (const Word& word : block.words)
    if (word.letter >= 'X') return word;
  return block.words.front();
}

void refuse_beside_orientation(const Block& block, const Reading& r) {
  if (!r.state.turns_tool) return;
  const Word& word = block.words.front();
  if (r.state.motion == MotionMode::cycle)
    refuse_word(block, r, word,
                "a drilling cycle of a program that turns the tool by A, B and C is not supported");
  if (r.state.contour != Contour::none)
    refuse_word(block, r, word,
                "G41 and G42 are not supported in a program that turns the tool by A, B and C");
}

bool has_axis_word(const SortedBlock& sorted) {
  return sorted.word('X') != nullptr || sorted.word('Y') != nullptr || sorted.word('Z') != nullptr;
}

std::string_view why_not_followed(const Reading& r) {
  const bool hint = may_execute(r.dialect) && !r.options.expand_subprograms;
  if (r.body.jumps)
    return hint ? "the program jumps: any block may run never or several times (--expand-subprograms "
                  "executes jumps whose "
                  "conditions are known)"
                : "the program jumps: any block may run never or several times";
  if (r.in_body())
    return hint && !r.body.subprogram ? "it is in a condition or a loop (--expand-subprograms executes those "
                                        "whose conditions are known)"
                                      : "it is in a condition, a loop or a subprogram";
  if (r.state.displaced != 0) return displacement_text(r);
  std::uint16_t unknown_modes = r.state.unknown_modes;
  // Only arcs and cycles depend on planes, only arcs on centres, only cycles on levels.
  const bool any = (unknown_modes & unknown_motion) != 0;
  const bool arc = r.state.motion == MotionMode::clockwise || r.state.motion == MotionMode::counter_clockwise;
  if (!any && r.state.motion < MotionMode::clockwise)
    unknown_modes &= static_cast<std::uint16_t>(~unknown_plane);
  if (!any && !arc) unknown_modes &= static_cast<std::uint16_t>(~unknown_centres);
  if (r.state.motion != MotionMode::cycle) unknown_modes &= static_cast<std::uint16_t>(~unknown_level);
  return unknown_modes != 0 ? unknown_mode_text(unknown_modes, r.dialect.sinumerik_words)
                            : std::string_view();
}

double feed_mm_min(const Reading& r) {
  const ModalState& state = r.state;
  constexpr std::uint16_t doubts = unknown_unit | unknown_feed_mode;
  if (!state.unit || state.feed_mode == FeedUnit::inverse_time || (state.unknown_modes & doubts) != 0)
    return 0;
  if (state.feed_of_axes) return 0;
  // Whether OVR= acts on FB=, too, is not known.
  if (r.own_feed && state.feed_share != 1) return 0;
  const std::optional<LengthUnit> own_unit = unit_of_feed(r);
  if (r.own_feed && !own_unit) return 0;
  const double feed = r.own_feed
                          ? *r.own_feed * mm_per(*own_unit)
                          : state.feed_share * state.feed * mm_per(state.feed_unit.value_or(*state.unit));
  return state.feed_mode == FeedUnit::per_turn ? feed * spindle_rpm(state) : feed;
}

bool has_known_orientation(const ModalState& state) {
  return !state.turns_tool || all_known(state.known_angles);
}

void note_machine_moves(const std::array<bool, 3>& moved_by_machine, Move& move) {
  for (std::size_t axis = 0; axis < 3; ++axis) move.moved_only_by_program[axis] = !moved_by_machine[axis];
}

Move& begin_move(const Block& block, Reading& r, Motion motion) {
  Move& move = r.program.moves.emplace_back();
  move.line = block.line;
  move.text_line = block.text_line;
  move.block_index = r.program.block_count - 1;
  move.block = block.span;
  move.motion = motion;
  move.unit = r.state.unit.value_or(LengthUnit::millimetres);
  if (has_known_orientation(r.state)) move.known_start = r.state.known;
  move.start_mm = r.state.position_mm;
  move.frame = static_cast<std::uint32_t>(r.state.frame);
  const Move* before = move_before(r.program, r.program.moves.size() - 1);
  if (before != nullptr && before->frame != move.frame) note_machine_moves(r.moved_by_machine, move);
  r.moved_by_machine.fill(false);
  r.state.cycle.left_at_earlier_retract = false;
  move.relative = r.relative();
  move.incremental = move.relative ? 0 : r.relative_axes & 7U;
  move.feed_mm_min = feed_mm_min(r);
  move.spindle_rpm = spindle_rpm(r.state);
  move.tool = tool_of(r);
  move.operation = r.operation.index_in(r.program, motion, as_tool(r.state.tool));
  if (r.state.force) move.force = r.state.force;
  move.sets_force = r.force_line == block.line;
  move.exact_stop = r.state.exact_stop;
  move.has_tool_length = has_tool_length(r);
  move.tool_in_spindle = r.state.tool > 0;
  move.tool_is_chosen = r.state.tool_chosen == r.state.tool;
  const bool cuts = motion != Motion::rapid || r.state.motion == MotionMode::cycle;
  if (cuts && r.state.known[2]) remark_other_length(block.line, r), remark_cut_without_length(block.line, r);
  return move;
}

Move& start_move(const Block& block, Reading& r, Motion motion) {
  // A block is one move: a call beside words moves last, and the position is unknown afterwards.
  std::vector<Move>& moves = r.program.moves;
  if (!moves.empty() && moves.back().block.begin == block.span.begin) moves.pop_back();
  const std::array<bool, 3> moved_by_machine = r.moved_by_machine;
  Move& move = begin_move(block, r, motion);
  if (!why_not_followed(r).empty()) note_machine_moves(moved_by_machine, move);
  move.block_delete = !empty(block.block_delete);
  if (r.sorted.has(Action::stop_once)) move.exact_stop = true;
  if (const Word* n = r.sorted.word('N')) move.block_number = count_of(*n);
  if ((r.state.displaced & modal_macro) != 0) forget_speeds(r.state);
  return move;
}

void allow_plain_changes(const Reading& r, Move& move) {
  const bool continues = !move.exact_stop;
  move.may_split = move.motion == Motion::feed && continues;
  move.may_jump = all_known(move.known_start) && jump_has_feed(r, move) && continues;
}

void move_by_machine(Reading& r, std::size_t axis) {
  r.state.known[axis] = false;
  r.moved_by_machine[axis] = true;
  if (axis == 2) r.state.cycle.initial.reset();
}

void fix_axis(Reading& r, Move& move, std::size_t axis) {
  move.words[axis].reset();
  move.fixed[axis] = true;
  r.state.known[axis] = false;
}

void forget_way(Move& move) {
  move.moved_only_by_program = move.known_start;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (move.words[axis]) move.known_start[axis] = false;
}

void place_words(const Block& block, Reading& r, Move& move) {
  const std::string_view why = why_not_followed(r);
  if (may_turn_tool(r)) place_angles(block, r, move, why.empty());
  const bool macro = only_calls_macro(r);
  bool all_plain = true, frame = false;
  move.calls_at_end = macro && !move.block_delete;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Word* word = r.sorted.word(letters_of_axes[axis]);
    if (word == nullptr) {
      move.calls_at_end = move.calls_at_end && r.state.known[axis];
      continue;
    }
    frame = frame || may_travel_frame(r, axis);
    if (macro)
      move.calls_at_end = place_macro_word(r, move, axis, *word) && move.calls_at_end;
    else
      place_word(r, move, axis, *word, why.empty());
    all_plain = all_plain && word->literal;
  }
  if (macro) place_unknown(r, move, 2), move.fixed[2] = true;
  if ((r.state.displaced & modal_macro) != 0) move.makes_hole = true;
  if (macro && r.sorted.word('Z') != nullptr)
    return note_uncorrected(block, r,
                            fmt::format("a block that calls a macro keeps its Z word: program this "
                                        "height in a block of its own before {}",
                                        r.dialect.sinumerik_words ? "MCALL" : "G66"));
  if (!why.empty()) return note_uncorrected(block, r, why);
  if (!all_plain)
    return note_uncorrected(
        block, r,
        r.options.evaluate
            ? "a position is a variable or an expression whose value is not known from the text"
            : "a position is a variable or an expression (--evaluate works out constants)");
  if (any_axis(move.fixed))
    return note_uncorrected(block, r,
                            frame
                                ? "the first difference (G91, IC) of an axis behind a change of the frame: "
                                  "SD42440 $SC_FRAME_OFFSET_INCR_PROG decides whether the axis also travels "
                                  "the change; program the axis under G90 before"
                                : "a relative position starts from an unknown position");
  if (!r.angle || place_by_angle(r, move)) return;
  for (std::size_t axis = 0; axis < 2; ++axis) fix_axis(r, move, axis);
  note_uncorrected(block, r, "ANG= needs exactly one of X and Y, in a line under G17");
}

void finish_move(Reading& r, Move& move) {
  if ((r.state.displaced & modal_macro) != 0) r.state.known.fill(false);
  if (has_known_orientation(r.state)) move.known_end = r.state.known;
  move.end_mm = r.state.position_mm;
  if (r.state.feed_mode == FeedUnit::inverse_time && move.motion == Motion::feed) set_inverse_time(r, move);
  allow_changes(r, move);
  if (r.corner) expect_corner_behind(move);
  if (r.after_corner) {
    expect_corner_before(move);
    const double unit = mm_per(r.state.unit.value_or(LengthUnit::millimetres));
    if (std::vector<Move>& moves = r.program.moves; moves.size() > 1)
      place_corner({r.after_corner->mm * unit, r.after_corner->kind}, moves[moves.size() - 2], move);
  }
  r.after_corner = r.corner;
}

double length_mm(const Reading& r, const Word& word) {
  const LengthUnit unit = r.state.unit.value_or(LengthUnit::millimetres);
  if (!is_increments(r, word)) return word.value * mm_per(unit);
  return word.value / (unit == LengthUnit::millimetres ? 1e3 : 1e4) * mm_per(unit);
}

void note_uncorrected(const Block& block, Reading& r, std::string_view why) {
  if (r.last_reason == why) return;
  r.last_reason = why;
  r.program.left_alone.push_back({block.line, r.last_reason, false, block.text_line});
}

void refuse_word(const Block& block, const Reading& r, const Word& word, const std::string& message) {
  refuse(r.program.file, block, word.span.begin, message);
}

void demand_unit(const Block& block, const Reading& r, const Word& word) {
  if (r.state.unit) return;
  const char* codes = (r.dialect.family & siemens_family) != 0 ? "G70 or G71" : "G20 or G21";
  refuse_word(block, r, word,
              fmt::format("{} before the unit is known: program {}, or give --units mm or --units inch",
                          word.letter, codes));
}

}  // namespace counterflex
