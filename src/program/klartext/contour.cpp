// Contours under RL and RR, with the blocks that approach and leave them.
#include "program/gcode/moves/contour.hpp"

#include <algorithm>
#include <array>

#include "program/klartext/read.hpp"
#include "program/text/lex.hpp"

namespace counterflex {
namespace {

void join_contour(Move& move, int group) {
  move.handling = Handling::group;
  move.group = group;
  move.may_split = move.may_jump = false;
}

/// Moves before a contour that are the end of another contour belong to that one.
void begin_contour(KlartextReading& r) {
  std::vector<Move>& moves = r.program.moves;
  std::size_t first = first_before_contour(r.program, r.state.run_begin);
  const bool continues = first < moves.size() && moves[first].group != 0;
  if (!continues) ++r.state.groups;
  for (; first < moves.size(); ++first) join_contour(moves[first], r.state.groups);
}

/// Whether X and Y are there, and X, Y and Z are plain absolute numbers.
bool has_plain_point(const KlartextReading& r) {
  for (const std::string_view axis : {"X", "Y", "Z"}) {
    const KlartextWord* word = find_word(r.words, axis);
    if (word == nullptr && axis != "Z") return false;
    if (word != nullptr && (!word->literal || word->incremental)) return false;
  }
  return true;
}

void add_unfollowed_approach(const KlartextBlock& block, KlartextReading& r) {
  forget_klartext_speeds(r.state);
  add_unfollowed_move(block, r, block.head + " needs X and Y as plain numbers; the contour is not corrected");
  r.state.displacements.erase(0);
  if (block.head == "APPR") r.state.displacements[0] = "a contour entered by this APPR is not corrected";
}

CutterSide side_of(const std::vector<KlartextWord>& words) {
  return find_word(words, "RL") != nullptr ? CutterSide::left : CutterSide::right;
}

/// APPR and DEP are shifted with their contour. The path between their points is not followed, nor is the end
/// of a DEP without a point.
void place_approach(const KlartextBlock& block, KlartextReading& r) {
  constexpr std::array<std::string_view, 3> axes{"X", "Y", "Z"};
  Move move = begin_klartext_move(block, r);
  move.motion = Motion::feed;
  const bool to_point = find_word(r.words, "X") != nullptr;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const KlartextWord* word = find_word(r.words, axes[axis]);
    if (word != nullptr) {
      r.state.position_mm[static_cast<Eigen::Index>(axis)] = klartext_length_mm(r, *word);
      move.words[axis] = AxisWord{word->number, word->decimals};
    }
    if (axis < 2) move.known_start[axis] = false;
    r.state.known[axis] = word != nullptr || (axis == 2 ? r.state.known[2] : to_point);
  }
  move.moved_only_by_program.fill(true);
  move.may_insert_words = block.head == "APPR";
  move.end_mm = r.state.position_mm;
  move.known_end = r.state.known;
  if (block.head == "APPR") begin_contour(r);
  join_contour(move, r.state.groups);
  r.state.contour = r.state.beside_contour = block.head == "APPR";
  if (block.head == "APPR") r.state.cutter_side = side_of(r.words);
  r.state.after_contour = block.head == "DEP";
  r.state.corner.reset();
  r.state.pole.reset();
  add_move(r, std::move(move));
  note_uncorrected(r, block.line, block.head + " is shifted with its contour; its path is not computed");
}

}  // namespace

void follow_contour(const KlartextBlock& block, KlartextReading& r, Move& move) {
  KlartextState& state = r.state;
  const bool line = block.head == "L";
  const KlartextWord* off = line ? find_word(r.words, "R") : nullptr;
  const bool on = find_word(r.words, "RL") != nullptr || find_word(r.words, "RR") != nullptr;
  const bool is_beside = state.contour && state.beside_contour;
  const bool changes_side = on && is_beside && side_of(r.words) != state.cutter_side;
  if (state.after_contour && !is_along_z(move)) state.after_contour = false;
  if (on && !state.contour) begin_contour(r);
  if (on) state.contour = true, state.after_contour = state.beside_contour = false;
  if (on) state.cutter_side = side_of(r.words);
  const bool divides = move.arc && move.may_split && state.contour && state.beside_contour;
  const bool leaves = off != nullptr && state.contour;
  // Pieces of a line on which the compensation changes would have it in one of them alone.
  if (state.contour && (!is_beside || changes_side || leaves)) move.stays_whole = true;
  if (is_beside && state.contour && !leaves && !is_along_z(move) && state.tool_along_z)
    move.cutter_side = state.cutter_side;
  if (state.contour || state.after_contour) join_contour(move, state.groups);
  if (divides) move.may_split = true;
  if (leaves) {
    state.contour = state.beside_contour = false;
    state.after_contour = true;
  }
  if (state.contour && !is_along_z(move)) state.beside_contour = true;
}

void read_klartext_approach(const KlartextBlock& block, KlartextReading& r) {
  const bool known = read_words(block, r);
  const bool enters = block.head == "APPR", point = known && has_plain_point(r);
  const bool no_point = find_word(r.words, "X") == nullptr && find_word(r.words, "Y") == nullptr &&
                        find_word(r.words, "Z") == nullptr;
  const bool to_circle_and_line = approach_kind(r.program.text, block) == "LCT";
  const bool contour = find_word(r.words, "RL") != nullptr || find_word(r.words, "RR") != nullptr;
  const bool words_fit = enters ? point && contour && !r.state.contour
                                : known && r.state.contour && (to_circle_and_line ? point : no_point);
  const bool here = r.state.displacements.empty() && !may_skip_or_repeat(r) && empty(block.block_delete);
  if (!words_fit || !here || !r.state.tool_along_z || !r.state.unit || find_word(r.words, "M") != nullptr)
    return add_unfollowed_approach(block, r);
  read_klartext_feed(r);
  place_approach(block, r);
}

}  // namespace counterflex
