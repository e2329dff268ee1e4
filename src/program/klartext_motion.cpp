#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/arc_radius.hpp"
#include "program/dialect.hpp"
#include "program/klartext_codes.hpp"
#include "program/klartext_read.hpp"
#include "program/lex.hpp"

namespace counterflex {
namespace {

constexpr std::array<std::string_view, 3> klartext_axes{"X", "Y", "Z"};

double mm_per_unit(const KlartextReading& r) {
  return r.state.unit ? mm_per(*r.state.unit) : 1.0;
}

/// F: mm/min, in inch programs tenths of an inch/min; expressions and feeds a tooth are not known.
void read_feed(KlartextReading& r) {
  KlartextState& state = r.state;
  const double tenths = state.unit == LengthUnit::inches && !state.feed_per_turn ? 0.1 : 1.0;
  for (const KlartextWord& word : r.words) {
    if (word.key == "F") state.feed_mm_min = word.literal ? word.value * mm_per_unit(r) * tenths : 0;
    if (word.key == "FAUTO") state.feed_mm_min = state.tool_feed_mm_min;
    if (word.key == "FU") state.feed_mm_min = word.value * mm_per_unit(r) * state.spindle_rpm;
    if (word.key == "FZ" || word.key == "FT") state.feed_mm_min = 0;
  }
}

void watch_rotary_axes(KlartextReading& r) {
  for (const KlartextWord& word : r.words)
    if (word.key.size() == 1 && std::string_view("ABCUVW").find(word.key[0]) != std::string_view::npos &&
        (!word.literal || word.value != 0))
      r.state.elsewhere[1] = "a rotary or further axis is not at zero";
}

void check_unit(const KlartextBlock& block, const KlartextReading& r) {
  if (!r.state.unit)
    refuse_klartext(
        r.program.text, r.program.file, block, block.parts[0].begin,
        "a move before the unit is known: BEGIN PGM says MM or INCH, or give mm or inch as the unit");
}

bool programs_axis(const KlartextReading& r) {
  return std::any_of(klartext_axes.begin(), klartext_axes.end(),
                     [&](auto axis) { return find_word(r.words, axis) != nullptr; });
}

bool all_incremental(const KlartextReading& r) {
  return std::all_of(r.words.begin(), r.words.end(), [](const KlartextWord& word) {
    return word.incremental ||
           std::find(klartext_axes.begin(), klartext_axes.end(), word.key) == klartext_axes.end();
  });
}

std::string why_elsewhere(const KlartextBlock& block, const KlartextReading& r) {
  if (!r.state.elsewhere.empty()) return r.state.elsewhere.begin()->second;
  return holds(r.doubtful, block.line)
             ? "a jump, a repetition or a call may run the block often or not at all"
             : "";
}

/// One coordinate: a word that may be changed, or one that is not known. An incremental word beside absolute
/// ones is carried along.
void place_coordinate(const KlartextWord& word, std::size_t axis, bool doubtful, KlartextReading& r,
                      Move& move) {
  KlartextState& state = r.state;
  const auto i = static_cast<Eigen::Index>(axis);
  const bool known_before = state.known[axis];
  state.known[axis] = false;
  if (doubtful || !word.literal || (word.incremental && !known_before)) {
    move.fixed[axis] = !word.incremental || (word.literal && !doubtful);
    return;
  }
  if (word.incremental) {
    state.position_mm[i] += word.value * mm_per_unit(r);
    if (!move.relative) return;
  } else {
    state.position_mm[i] = word.value * mm_per_unit(r);
  }
  state.known[axis] = true;
  move.words[axis] = AxisWord{word.number, word.decimals};
}

void place_coordinates(const KlartextBlock& block, KlartextReading& r, Move& move) {
  const std::string elsewhere = why_elsewhere(block, r);
  move.relative = all_incremental(r);
  bool expression = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const KlartextWord* word = find_word(r.words, klartext_axes[axis]);
    if (word == nullptr) continue;
    expression = expression || !word->literal;
    place_coordinate(*word, axis, !elsewhere.empty(), r, move);
  }
  if (!elsewhere.empty()) {
    r.state.known.fill(false);
    leave_alone(r, block.line, elsewhere);
  } else if (expression) {
    leave_alone(r, block.line, "a Q parameter gives the position");
  }
}

/// The centre of an arc of given radius; nothing where its ends are the same or further apart than it
/// reaches.
std::optional<Vector3> centre_of_radius(const Move& move, double radius, bool clockwise) {
  const double half = 0.5 * (move.end_mm - move.start_mm).head<2>().norm();
  if (half == 0 || half > std::abs(radius) * 1.001) return std::nullopt;
  return centre_from_radius(move.start_mm, move.end_mm, radius, (clockwise ? -1 : 1) * Vector3::UnitZ());
}

void set_arc(const KlartextBlock& block, KlartextReading& r, Move& move, bool clockwise) {
  ArcMove arc;
  arc.clockwise = clockwise;
  if (block.head == "CR") {
    const KlartextWord* radius = find_word(r.words, "R");
    if (radius == nullptr || !radius->literal) return;
    arc.radius_word = AxisWord{radius->number, radius->decimals};
    arc.radius_mm = radius->value * mm_per_unit(r);
    const auto centre = centre_of_radius(move, arc.radius_mm, clockwise);
    if (!centre) return;
    arc.centre_mm = *centre;
  } else {
    if (!r.state.pole) return;
    arc.absolute_centre = true;
    arc.centre_mm = r.state.pole->centre_mm;
    if (r.state.pole->just_set)
      arc.centre_words = {r.state.pole->words[0], r.state.pole->words[1], std::nullopt};
  }
  arc.centre_mm.z() = move.start_mm.z();
  move.arc = arc;
}

/// C and CR with plain absolute coordinates in the plane XY from a known start.
void read_arc(const KlartextBlock& block, KlartextReading& r, Move& move) {
  const KlartextWord* sense = find_word(r.words, "DR");
  const bool sense_known = sense != nullptr && !empty(sense->number);
  const bool plane = r.state.tool_along_z && find_word(r.words, "Z") == nullptr && !move.relative;
  const bool ends_known = move.known_start[0] && move.known_start[1] && r.state.known[0] && r.state.known[1];
  if (sense_known && plane && ends_known) set_arc(block, r, move, r.program.text[sense->number.begin] == '-');
  if (move.arc) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!move.words[axis] && !move.fixed[axis]) continue;
    move.fixed[axis] = true;
    move.words[axis].reset();
    r.state.known[axis] = false;
  }
  leave_alone(r, block.line, "an arc whose start or centre is not known");
}

bool moves_in_plane(const Move& move) {
  return move.words[0] || move.words[1] || move.fixed[0] || move.fixed[1];
}

void join_contour(Move& move, int group) {
  move.handling = Handling::group;
  move.group = group;
  move.may_split = move.may_jump = false;
}

/// The moves before a contour that belong to it: those along Z, and the last one in the plane before them.
/// Those that already end another contour go on with it.
void begin_contour(KlartextReading& r) {
  std::vector<Move>& moves = r.program.moves;
  std::size_t first = moves.size();
  bool entered = false;
  while (first > r.state.run_begin && !entered && moves[first - 1].group == 0)
    entered = moves_in_plane(moves[--first]);
  const bool goes_on = !entered && first > r.state.run_begin;
  if (!goes_on) ++r.state.groups;
  for (; first < moves.size(); ++first) join_contour(moves[first], r.state.groups);
}

/// RL and RR begin a contour, R0 ends it with its move and those along Z after it.
void follow_contour(const KlartextBlock& block, KlartextReading& r, Move& move) {
  KlartextState& state = r.state;
  const bool line = block.head == "L";
  const KlartextWord* off = line ? find_word(r.words, "R") : nullptr;
  const bool on = find_word(r.words, "RL") != nullptr || find_word(r.words, "RR") != nullptr;
  if (state.after_contour && moves_in_plane(move)) state.after_contour = false;
  if (on && !state.contour) begin_contour(r);
  if (on) state.contour = true, state.after_contour = false;
  if (state.contour || state.after_contour) join_contour(move, state.groups);
  if (off != nullptr && state.contour) {
    state.contour = false;
    state.after_contour = true;
  }
}

void allow_klartext_changes(const KlartextCodes& codes, bool tangent, KlartextReading& r, Move& move) {
  const bool divided = !codes.acts_after && !r.state.rounds_next && !tangent;
  const bool feed = move.motion == Motion::feed;
  move.may_split = feed && divided;
  move.may_jump = all_known(move.known_start) && move.feed_mm_min > 0 && divided;
  r.state.rounds_next = false;
}

void call_cycle_after(const KlartextBlock& block, KlartextReading& r, Move& move) {
  r.state.known[2] = false;
  if (why_elsewhere(block, r).empty() && r.state.cycle_acts_here && hold_hole(r, move))
    return leave_alone(r, block.line, "holes are held");
  r.state.surface.reset();
  move.fixed[2] = true;
  move.words[2].reset();
  if (!r.state.cycle_acts_here) move.fixed.fill(true), move.words.fill({}), r.state.known.fill(false);
  leave_alone(r, block.line, "cycles are left as they are");
}

void leave_machine_position(const KlartextBlock& block, KlartextReading& r) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (find_word(r.words, klartext_axes[axis]) != nullptr) take_away(r, axis);
  r.state.run_begin = r.program.moves.size();
  r.state.contour = r.state.after_contour = false;
  r.program.left_alone.push_back({block.line, "M91 or M92: a position of the machine", true});
}

/// How far M140 goes depends on the machine: a word put into the next block would go back.
void leave_retract(const KlartextBlock& block, KlartextReading& r) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (axis == 2 || !r.state.tool_along_z) take_away(r, axis);
  r.state.run_begin = r.program.moves.size();
  r.state.contour = r.state.after_contour = false;
  r.program.left_alone.push_back({block.line, "M140 leaves the part along the tool", true});
}

/// After a block that may be skipped its axes are in doubt.
void doubt_klartext_skippable(const KlartextBlock& block, KlartextReading& r, const Move& move) {
  if (empty(block.block_delete)) return;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (move.words[axis]) r.state.known[axis] = false;
}

/// The arc about a pole has the words of its CC, and those that follow it find the pole where it has left it.
/// One that stays as it is, or may be skipped, leaves the CC to nobody.
void use_pole(KlartextReading& r, const Move& move) {
  const bool taken = move.arc && (move.words[0] || move.words[1]) && !move.block_delete;
  if (!taken) return r.state.pole.reset();
  r.state.pole->just_set = false;
}

void add_klartext_move(const KlartextBlock& block, const KlartextCodes& codes, KlartextReading& r) {
  check_unit(block, r);
  Move move = begin_klartext_move(block, r);
  const bool rapid = find_word(r.words, "FMAX") != nullptr;
  move.motion = rapid ? Motion::rapid : Motion::feed;
  place_coordinates(block, r, move);
  move.end_mm = r.state.position_mm;
  if (block.head == "C" || block.head == "CR") read_arc(block, r, move);
  const bool tangent = block.head == "CT";
  if (tangent) move.handling = Handling::held;
  allow_klartext_changes(codes, tangent, r, move);
  follow_contour(block, r, move);
  if (codes.cycle_call) call_cycle_after(block, r, move);
  move.known_end = r.state.known;
  move.may_insert_words = move.words[0] || move.words[1] || move.words[2];
  doubt_klartext_skippable(block, r, move);
  if (block.head == "C") use_pole(r, move);
  r.program.moves.push_back(std::move(move));
}

}  // namespace

Move begin_klartext_move(const KlartextBlock& block, KlartextReading& r) {
  const KlartextState& state = r.state;
  Move move;
  move.line = block.line;
  move.block_index = r.program.block_count - 1;
  move.block = block.span;
  move.unit = state.unit.value_or(LengthUnit::millimetres);
  move.known_start = state.known;
  if (!why_elsewhere(block, r).empty())
    for (std::size_t axis = 0; axis < 3; ++axis)
      move.stands[axis] = state.taken_away[axis] != r.program.moves.size() + 1;
  move.start_mm = move.end_mm = state.position_mm;
  move.feed_mm_min = state.feed_mm_min * (state.feed_per_turn ? state.spindle_rpm : 1.0);
  move.spindle_rpm = state.spindle_rpm;
  if (!empty(block.number)) {
    long number = 0;
    for (const char c : part(r.program.text, block.number).substr(0, 9)) number = 10 * number + (c - '0');
    move.block_number = number;
  }
  move.tool = as_tool(state.tool);
  move.operation = r.operation.index_in(r.program);
  move.may_insert_words = false;
  move.force = state.force;
  move.block_delete = !empty(block.block_delete);
  return move;
}

void take_away(KlartextReading& r, std::size_t axis) {
  r.state.known[axis] = false;
  r.state.taken_away[axis] = r.program.moves.size() + 1;
}

void read_klartext_motion(const KlartextBlock& block, KlartextReading& r) {
  if (!lex_klartext_words(r.program.text, r.program.file, block, r.words))
    return add_unfollowed_move(block, r, fmt::format("the block {} has words that are not read", block.head));
  const KlartextCodes codes = read_klartext_m(block, r);
  read_feed(r);
  watch_rotary_axes(r);
  if (block.head == "CP" && !codes.machine_position && !codes.cycle_call) {
    add_polar_arc(block, r);
  } else if (block.head == "CP") {
    add_unfollowed_move(block, r, "a polar arc is not followed");
  } else if (codes.machine_position && programs_axis(r)) {
    leave_machine_position(block, r);
  } else if (programs_axis(r)) {
    add_klartext_move(block, codes, r);
  } else if (codes.cycle_call) {
    add_cycle_call(block, r);
  } else if (find_word(r.words, "R") != nullptr && r.state.contour) {
    r.state.contour = false;
    r.state.after_contour = true;
  }
  if (codes.retracts) leave_retract(block, r);
  r.ended = r.ended || codes.ends;
}

void read_klartext_pole(const KlartextBlock& block, KlartextReading& r) {
  r.state.pole.reset();
  const bool moves = std::binary_search(r.polar.begin(), r.polar.end(), block.line);
  if (!lex_klartext_words(r.program.text, r.program.file, block, r.words) || r.words.size() != 2 || moves)
    return;
  KlartextPole pole;
  pole.just_set = true;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const KlartextWord* word = find_word(r.words, klartext_axes[axis]);
    if (word == nullptr || word->incremental || !word->literal || !empty(block.block_delete)) return;
    pole.words[axis] = {word->number, word->decimals};
    pole.centre_mm[static_cast<Eigen::Index>(axis)] = word->value * mm_per_unit(r);
  }
  r.state.pole = pole;
}

void read_klartext_codes(const KlartextBlock& block, KlartextReading& r) {
  KlartextBlock codes = block;
  codes.head.clear();
  if (!lex_klartext_words(r.program.text, r.program.file, codes, r.words))
    return add_unfollowed_move(block, r, "the block M has words that are not read");
  const KlartextCodes found = read_klartext_m(block, r);
  if (programs_axis(r)) return add_unfollowed_move(block, r, "axes without L are not read");
  if (found.cycle_call) add_cycle_call(block, r);
  if (found.retracts) leave_retract(block, r);
  r.ended = r.ended || found.ends;
}

}  // namespace counterflex
