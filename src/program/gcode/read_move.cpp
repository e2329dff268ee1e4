#include "program/gcode/read_move.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "counterflex/geometry/curve.hpp"
#include "program/expand/expand.hpp"

namespace counterflex {
namespace {

bool is_increments(const Reading& r, const Word& word) {
  return !word.point && r.options.integer_words == IntegerWords::increments &&
         r.dialect.integer_words_doubtful;
}

double feed_mm_min(const ModalState& state) {
  if (!state.unit || state.feed_mode == FeedUnit::inverse_time) return 0;
  const double feed = state.feed * mm_per(state.feed_unit.value_or(*state.unit));
  return state.feed_mode == FeedUnit::per_turn ? feed * state.spindle_rpm : feed;
}

/// Length of the move's way (mm); 0 where it is not known.
double way_mm(const Move& move) {
  if (!all_known(move.known_start) || !all_known(move.known_end)) return 0;
  if (!move.arc) return (move.end_mm - move.start_mm).norm();
  const Vector3 normal = normal_of(*move.arc);
  const double sweep =
      sweep_between(move.start_mm, move.end_mm, move.arc->centre_mm, normal, move.arc->turns);
  return length({move.start_mm, move.end_mm, Arc{move.arc->centre_mm, normal, sweep}});
}

/// G93: F holds for this block alone.
void set_inverse_time(const Reading& r, Move& move) {
  move.feed_mode = FeedMode::inverse_time;
  const Word* f = r.sorted.word('F');
  if (f == nullptr || !f->literal) return;
  move.feed_per_min = f->value;
  move.feed_mm_min = f->value * way_mm(move);
}

bool any(const std::array<bool, 3>& axes) {
  return axes[0] || axes[1] || axes[2];
}

/// Words with which inserted points would change what a block does.
void allow_changes(const Reading& r, Move& move) {
  const SortedBlock& b = r.sorted;
  const bool feed = move.motion == Motion::feed;
  const bool unit = b.has(Action::inch) || b.has(Action::mm);  // an F copied before it would change its unit
  const bool tool_length = b.has(Action::tool_length) || b.has(Action::no_tool_length);
  const bool acts_at_end = b.has(MAction::acts_after) || b.has(MAction::end) || b.has(MAction::tool_change) ||
                           b.has(MAction::retract) || b.has(MAction::machine);
  const bool rigid = r.relative() != r.state.relative || move.handling != Handling::own || any(move.fixed) ||
                     move.cycle.has_value();
  // Pieces of a G93 move need a share of its time.
  const bool shares_time = move.feed_mode != FeedMode::inverse_time || move.feed_per_min > 0;
  // Words and blocks that are inserted count as the modal state has it.
  const bool counts_otherwise = r.relative() != r.state.relative;
  // The control takes the size of a corner off both of the blocks that make it, which lie in one plane.
  const bool corner = r.corner || r.after_corner;
  move.may_insert_words = move.may_insert_words && !tool_length && !any(move.fixed) && !counts_otherwise;
  move.may_split =
      feed && !corner && !rigid && !move.exact_stop && !tool_length && !acts_at_end && shares_time;
  const bool only_motion = b.g.empty() || (b.g.size() == 1 && b.g[0].code->group == CodeGroup::motion);
  move.stays_whole = rigid || !shares_time || !only_motion || !b.m.empty() || b.has_any("ABCDHLPQSTUVW");
  move.may_jump = all_known(move.known_start) && !corner && !rigid && move.feed_mm_min > 0 &&
                  !move.exact_stop && !acts_at_end && !unit && (feed ? move.may_split : only_motion);
}

std::string_view displacement_text(std::uint16_t bits) {
  if ((bits & rotary) != 0) return "a word of A, B, C, U, V or W is not zero: further axes are not followed, and corners are written ,C and ,R";
  if ((bits & tool_point) != 0) return "the control follows the tool's centre point";
  if ((bits & kinematics) != 0) return "the kinematics were switched";
  if ((bits & rotated) != 0) return "coordinates are rotated";
  if ((bits & scaled) != 0) return "coordinates are scaled";
  if ((bits & mirrored) != 0) return "coordinates are mirrored";
  if ((bits & polar) != 0) return "coordinates are polar";
  if ((bits & modal_macro) != 0) return "every move calls a macro, whose heights are not corrected";
  if ((bits & framed) != 0) return "a frame shifts or turns coordinates";
  if ((bits & unknown) != 0) return "a code that is not known may act";
  if ((bits & tilted) != 0) return "coordinates are tilted";
  if ((bits & data) != 0) return "G10 has set the work offset";
  return (bits & shifted) != 0 ? "G52 shifts the coordinates" : "G92 has set the position";
}

std::string_view doubt_text(std::uint16_t doubts) {
  if ((doubts & doubtful_unit) != 0) return "its unit is in doubt";
  if ((doubts & doubtful_offset) != 0) return "its work offset is in doubt";
  if ((doubts & doubtful_distance) != 0) return "whether G90 or G91 acts is in doubt";
  if ((doubts & doubtful_cutter) != 0) return "whether G41 or G42 acts is in doubt";
  return "its motion is in doubt";
}

/// Whether all that is not followed is a macro that every move calls: the moves to its places are plain.
bool only_calls_macro(const Reading& r) {
  return r.state.displaced == modal_macro && !r.in_body() && r.state.doubts == 0;
}

/// A word whose place is not followed.
void place_unknown(Reading& r, Move& move, std::size_t axis) {
  const bool relative = r.relative() && (r.state.doubts & doubtful_distance) == 0;
  move.fixed[axis] = !relative;
  r.state.known[axis] = false;
}

/// The place of a hole in the plane goes along with the contours. Its heights are the macro's, and where that leaves the
/// tool is not known.
void place_macro_word(Reading& r, Move& move, std::size_t axis, const Word& word) {
  place_unknown(r, move, axis);
  if (!word.literal || axis == 2 || r.relative()) return;
  move.fixed[axis] = false;
  move.words[axis] = AxisWord{word.number, word.decimals};
  coordinate(r.state.position_mm, axis) = length_mm(r, word);
}

void place_word(Reading& r, Move& move, std::size_t axis, const Word& word, bool followed) {
  ModalState& state = r.state;
  const bool alone = (r.relative_axes >> axis & 1) != 0;
  const bool relative = alone || (r.relative() && (state.doubts & doubtful_distance) == 0);
  if (!word.literal || !followed) return place_unknown(r, move, axis);
  if (relative && !state.known[axis]) return fix_axis(r, move, axis);
  move.words[axis] = AxisWord{word.number, word.decimals};
  const double value = length_mm(r, word);
  coordinate(state.position_mm, axis) = relative ? coordinate(state.position_mm, axis) + value : value;
  if (!state.known[axis]) state.known[axis] = true;  // a byte just stored delays the copy of all three
}

/// T in the spindle; where the program has changed to none, the tool whose length it has taken.
std::int32_t tool_of(const Reading& r) {
  if (r.state.tool > 0) return as_tool(r.state.tool);
  // On a Sinumerik the length is that of an edge of the tool, D.
  const bool by_length = r.state.tool_length && !r.dialect.sinumerik_words;
  return by_length && *r.state.tool_length <= INT32_MAX ? as_tool(static_cast<long>(*r.state.tool_length))
                                                        : 0;
}

/// ANG= beside one word of X and Y says the other: the line has this direction. False where it is not followed.
bool place_by_angle(Reading& r, Move& move) {
  constexpr double along = 1e-6;  // of a direction: nearly along the axis that is not said
  const Word& angle = *r.angle;
  const std::size_t said = move.words[0] ? 0 : 1, other = 1 - said;
  const bool line = r.state.motion == MotionMode::rapid || r.state.motion == MotionMode::feed;
  if (!line || r.state.normal != 2 || !angle.literal || !move.words[said] || move.words[other] || !r.state.known[0] ||
      !r.state.known[1])
    return false;
  const double radians = angle.value * std::numbers::pi / 180;
  const double direction[2] = {std::cos(radians), std::sin(radians)};
  if (std::abs(direction[said]) < along) return false;
  const double way = coordinate(r.state.position_mm, said) - move.start_mm[static_cast<Eigen::Index>(said)];
  coordinate(r.state.position_mm, other) += way * direction[other] / direction[said];
  move.words[other] = AxisWord{angle.number, 0};
  move.angle_axis = other == 0 ? 1 : 2;
  return true;
}

}  // namespace

const Word& first_axis_word(const Block& block) {
  for (const Word& word : block.words)
    if (word.letter >= 'X') return word;
  return block.words.front();
}

bool has_axis_word(const SortedBlock& sorted) {
  return sorted.word('X') != nullptr || sorted.word('Y') != nullptr || sorted.word('Z') != nullptr;
}

std::string_view why_not_followed(const Reading& r) {
  const bool hint = may_execute(r.dialect) && !r.options.expand_subprograms;
  if (r.body.jumps)
    return hint ? "the program jumps: any block may run never or often (--expand-subprograms executes jumps whose "
                  "conditions are known)"
                : "the program jumps: any block may run never or often";
  if (r.in_body())
    return hint && !r.body.subprogram
               ? "it stands in a condition or a loop (--expand-subprograms executes those whose conditions are known)"
               : "it stands in a condition, a loop or a subprogram";
  if (r.state.displaced != 0) return displacement_text(r.state.displaced);
  std::uint16_t doubts = r.state.doubts;
  // Planes and centres matter to arcs and cycles alone, levels to cycles.
  const bool curved = r.state.motion >= MotionMode::clockwise || (doubts & doubtful_motion) != 0;
  if (!curved) doubts &= static_cast<std::uint16_t>(~(doubtful_plane | doubtful_centres));
  if (r.state.motion != MotionMode::cycle) doubts &= static_cast<std::uint16_t>(~doubtful_level);
  return doubts != 0 ? doubt_text(doubts) : std::string_view();
}

Move& begin_move(const Block& block, Reading& r, Motion motion) {
  Move& move = r.program.moves.emplace_back();
  move.line = block.line;
  move.text_line = block.text_line;
  move.block_index = r.program.block_count - 1;
  move.block = block.span;
  move.motion = motion;
  move.unit = r.state.unit.value_or(LengthUnit::millimetres);
  move.known_start = r.state.known;
  move.start_mm = r.state.position_mm;
  r.taken_away.fill(false);
  move.relative = r.relative();
  move.incremental = move.relative ? 0 : r.relative_axes & 7U;
  move.feed_mm_min = feed_mm_min(r.state);
  move.spindle_rpm = r.state.spindle_rpm;
  move.frame = static_cast<std::uint32_t>(r.state.frame);
  move.tool = tool_of(r);
  move.operation = r.operation.index_in(r.program);
  if (r.state.force) move.force = r.state.force;
  move.exact_stop = r.state.exact_stop;
  return move;
}

Move& start_move(const Block& block, Reading& r, Motion motion) {
  // A block is one move: a call beside words is what moves last, and leaves nothing known.
  std::vector<Move>& moves = r.program.moves;
  if (!moves.empty() && moves.back().block.begin == block.span.begin) moves.pop_back();
  const std::array<bool, 3> taken_away = r.taken_away;
  Move& move = begin_move(block, r, motion);
  if (!why_not_followed(r).empty())
    for (std::size_t axis = 0; axis < 3; ++axis) move.stands[axis] = !taken_away[axis];
  move.block_delete = !empty(block.block_delete);
  if (r.sorted.has(Action::stop_once)) move.exact_stop = true;
  if (const Word* n = r.sorted.word('N')) move.block_number = count_of(*n);
  return move;
}

void allow_plain_changes(Move& move) {
  const bool goes_on = !move.exact_stop;
  move.may_split = move.motion == Motion::feed && goes_on;
  move.may_jump = all_known(move.known_start) && move.feed_mm_min > 0 && goes_on;
}

void take_away(Reading& r, std::size_t axis) {
  r.state.known[axis] = false;
  r.taken_away[axis] = true;
}

void fix_axis(Reading& r, Move& move, std::size_t axis) {
  move.words[axis].reset();
  move.fixed[axis] = true;
  r.state.known[axis] = false;
}

void place_words(const Block& block, Reading& r, Move& move) {
  const std::string_view why = why_not_followed(r);
  const bool macro = only_calls_macro(r);
  bool all_plain = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Word* word = r.sorted.word(letters_of_axes[axis]);
    if (word == nullptr) continue;
    if (macro)
      place_macro_word(r, move, axis, *word);
    else
      place_word(r, move, axis, *word, why.empty());
    all_plain = all_plain && word->literal;
  }
  if (macro) place_unknown(r, move, 2), move.fixed[2] = true;
  if (!why.empty()) return leave_alone(block, r, why);
  if (!all_plain)
    return leave_alone(block, r,
                       r.options.evaluate ? "a position is a variable or an expression whose value the text does not show"
                                          : "a position is a variable or an expression (--evaluate works out constants)");
  if (any(move.fixed)) return leave_alone(block, r, "a relative position counts from an unknown one");
  if (!r.angle || place_by_angle(r, move)) return;
  for (std::size_t axis = 0; axis < 2; ++axis) fix_axis(r, move, axis);
  leave_alone(block, r, "ANG= is followed beside one of X and Y alone, in a line of G17");
}

void finish_move(Reading& r, Move& move) {
  move.known_end = r.state.known;
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

void leave_alone(const Block& block, Reading& r, std::string_view why) {
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
              fmt::format("{} before the unit is known: program {}, or give --units mm or --units inch", word.letter, codes));
}

}  // namespace counterflex
