// Contours under RL and RR, with the blocks that approach and leave them.
#include <algorithm>
#include <array>

#include "program/gcode/contour.hpp"
#include "program/klartext/read.hpp"
#include "program/text/lex.hpp"

namespace counterflex {
namespace {

void join_contour(Move& move, int group) {
  move.handling = Handling::group;
  move.group = group;
  move.may_split = move.may_jump = false;
}

/// Moves before a contour that already end another one belong to that.
void begin_contour(KlartextReading& r) {
  std::vector<Move>& moves = r.program.moves;
  std::size_t first = first_before_contour(r.program, r.state.run_begin);
  const bool goes_on = first < moves.size() && moves[first].group != 0;
  if (!goes_on) ++r.state.groups;
  for (; first < moves.size(); ++first) join_contour(moves[first], r.state.groups);
}

/// The words behind the kind of APPR and DEP; nothing where the kind is polar or none of these, or a word is
/// not read.
std::optional<std::string> lex_approach(const KlartextBlock& block, KlartextReading& r) {
  const std::string_view text = r.program.text;
  KlartextBlock words = block;
  std::size_t& at = words.parts[0].begin;
  at += block.head.size();
  while (at < words.parts[0].end && (text[at] == ' ' || text[at] == '\t')) ++at;
  constexpr std::array<std::string_view, 4> kinds{"LCT", "LT", "LN", "CT"};
  for (const std::string_view kind : kinds) {
    if (squeezed(text.substr(at, kind.size())) != kind) continue;
    at += kind.size();
    words.head.clear();
    if (!read_words(words, r)) return std::nullopt;
    return std::string(kind);
  }
  return std::nullopt;
}

/// Whether X and Y are there, and they and Z are plain numbers and no differences.
bool has_plain_point(const KlartextReading& r) {
  for (const std::string_view axis : {"X", "Y", "Z"}) {
    const KlartextWord* word = find_word(r.words, axis);
    if (word == nullptr && axis != "Z") return false;
    if (word != nullptr && (!word->literal || word->incremental)) return false;
  }
  return true;
}

void leave_unknown(const KlartextBlock& block, KlartextReading& r) {
  add_unfollowed_move(block, r,
                      block.head + " is followed with plain numbers of X and Y only; the contour stays");
  r.state.elsewhere.erase(0);
  if (block.head == "APPR") r.state.elsewhere[0] = "a contour that APPR has entered is not corrected";
}

/// APPR and DEP go along with their contour. Their way between is not followed, nor is where DEP ends without
/// a point.
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
  move.stands.fill(true);
  move.may_insert_words = block.head == "APPR";
  move.end_mm = r.state.position_mm;
  move.known_end = r.state.known;
  if (block.head == "APPR") begin_contour(r);
  join_contour(move, r.state.groups);
  r.state.contour = r.state.beside_contour = block.head == "APPR";
  r.state.after_contour = block.head == "DEP";
  r.state.corner.reset();
  r.state.pole.reset();
  add_move(r, std::move(move));
  leave_alone(r, block.line, block.head + " goes along with its contour; its way is not measured");
}

}  // namespace

void follow_contour(const KlartextBlock& block, KlartextReading& r, Move& move) {
  KlartextState& state = r.state;
  const bool line = block.head == "L";
  const KlartextWord* off = line ? find_word(r.words, "R") : nullptr;
  const bool on = find_word(r.words, "RL") != nullptr || find_word(r.words, "RR") != nullptr;
  if (state.after_contour && !goes_along_z(move)) state.after_contour = false;
  if (on && !state.contour) begin_contour(r);
  if (on) state.contour = true, state.after_contour = state.beside_contour = false;
  const bool divides = move.arc && move.may_split && state.contour && state.beside_contour;
  if (state.contour || state.after_contour) join_contour(move, state.groups);
  if (divides) move.may_split = true;
  if (off != nullptr && state.contour) {
    state.contour = state.beside_contour = false;
    state.after_contour = true;
  }
  if (state.contour && !goes_along_z(move)) state.beside_contour = true;
}

void read_klartext_approach(const KlartextBlock& block, KlartextReading& r) {
  const auto kind = lex_approach(block, r);
  const bool enters = block.head == "APPR", point = kind && has_plain_point(r);
  const bool no_point = find_word(r.words, "X") == nullptr && find_word(r.words, "Y") == nullptr &&
                        find_word(r.words, "Z") == nullptr;
  const bool contour = find_word(r.words, "RL") != nullptr || find_word(r.words, "RR") != nullptr;
  const bool words_fit = enters ? point && contour && !r.state.contour
                                : kind && r.state.contour && (*kind == "LCT" ? point : no_point);
  const bool here = r.state.elsewhere.empty() && !in_doubt(r) && empty(block.block_delete);
  if (!words_fit || !here || !r.state.tool_along_z || !r.state.unit || find_word(r.words, "M") != nullptr)
    return leave_unknown(block, r);
  read_klartext_feed(r);
  place_approach(block, r);
}

}  // namespace counterflex
