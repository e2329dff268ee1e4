#include "program/gcode/moves/read_cycle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/gcode/moves/read_move.hpp"
#include "program/gcode/remarks.hpp"

namespace counterflex {
namespace {

PackedAxisWord axis_word(const Word* word) {
  if (word == nullptr || !word->literal) return std::nullopt;
  return AxisWord{word->number, word->decimals};
}

void keep_sticky(const Reading& r, const Word* word, std::optional<double>& value) {
  if (word == nullptr) return;
  value.reset();
  if (word->literal) value = length_mm(r, *word);
}

/// L, or K of Fanuc; 1 without such a word. Beside I and J, K is a peck as on a Haas. Empty: not an integer
/// that a control takes.
std::optional<int> repeats_of(const Reading& r) {
  constexpr double most_repeats = 9999;
  const Word* word = r.sorted.word('L');
  if (word == nullptr && r.dialect.k_repeats_holes && !r.sorted.has_any("IJ")) word = r.sorted.word('K');
  if (word == nullptr) return 1;
  if (!word->literal || !(word->value >= 0 && word->value <= most_repeats)) return std::nullopt;
  if (word->value != std::floor(word->value)) return std::nullopt;
  return static_cast<int>(word->value);
}

bool plain_words(const Reading& r) {
  for (const char letter : {'X', 'Y', 'Z', 'R', 'L', 'K'})
    if (const Word* word = r.sorted.word(letter); word != nullptr && !word->literal) return false;
  return true;
}

/// Z of the retract plane and of the bottom. Without R the tool returns to the height at which it began.
void set_levels(const ModalState& state, CycleMove& hole) {
  const CycleState& cycle = state.cycle;
  const double initial = cycle.initial.value_or(0);
  hole.retract_mm = cycle.retract ? *cycle.retract + (cycle.relative ? initial : 0) : initial;
  hole.bottom_mm = cycle.bottom.value_or(hole.retract_mm) + (cycle.relative ? hole.retract_mm : 0);
}

/// Whether G98 and G99 leave the tool at the same height.
bool is_above_start(const ModalState& state, const CycleMove& hole) {
  return state.cycle.initial && hole.retract_mm >= *state.cycle.initial;
}

/// The height at which the cycle leaves the tool. The retract plane is known if the hole has R, or if the
/// tool is already at the plane. It is then known in the corrected text, too.
void set_height_after_hole(ModalState& state, const CycleMove& hole) {
  CycleState& cycle = state.cycle;
  const bool has_retract = hole.retract_word && (!cycle.relative || cycle.initial);
  const bool stays = state.known[2] && cycle.left_at_retract && state.position_mm.z() == hole.retract_mm;
  const bool retract_known = has_retract || stays;
  const bool at_retract = hole.returns_to_retract || is_above_start(state, hole);
  if (at_retract) {
    state.known[2] = retract_known && (hole.returns_to_retract || cycle.initial);
    state.position_mm.z() = hole.retract_mm;
  } else {
    state.known[2] = cycle.initial.has_value();
    state.position_mm.z() = cycle.initial.value_or(0);
  }
  cycle.left_at_retract = at_retract;
  cycle.left_at_earlier_retract = at_retract && !retract_known;
}

/// X and Y. Relative words apply again in each repeat.
void place_hole(Reading& r, Move& move, int repeats, bool followed) {
  ModalState& state = r.state;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const Word* word = r.sorted.word(letters_of_axes[axis]);
    if (word == nullptr) continue;
    if (!word->literal || !followed || (state.relative && !state.known[axis])) {
      fix_axis(r, move, axis);
      continue;
    }
    move.words[axis] = AxisWord{word->number, word->decimals};
    double& place = coordinate(state.position_mm, axis);
    place = state.relative ? place + repeats * length_mm(r, *word) : length_mm(r, *word);
    state.known[axis] = true;
  }
}

bool is_first(const Reading& r) {
  return r.sorted.has(Action::cycle);
}

/// Whether the series begins. If the initial height was lost (by a hole that is not followed, or by another
/// work offset, which makes all axes unknown), it stays unknown.
bool begins_series(ModalState& state) {
  CycleState& cycle = state.cycle;
  const bool follows_hole = cycle.left_at_earlier_retract && state.known[0] && state.known[1];
  if (!state.known[2] && !follows_hole) cycle.initial.reset();
  if (cycle.begun) return false;
  cycle.begun = cycle.left_at_retract = true;
  if (state.known[2]) cycle.initial = state.position_mm.z();
  return true;
}

/// After a hole that returns to the initial height of the series, the height is unknown.
void forget_initial(ModalState& state) {
  state.cycle.initial.reset();
  state.cycle.left_at_retract = false;
}

/// Reads whether Z and R of the cycle are under G90 or G91 in this hole. True if numbers of an earlier hole
/// have another meaning here: then their shift does not apply to this hole.
bool turns_sticky_numbers(Reading& r, bool begins) {
  CycleState& cycle = r.state.cycle;
  const bool before = cycle.relative;
  // Shop controls keep a depth that was programmed under G90 when G91 moves to further holes.
  if (is_first(r) || r.sorted.has_any("ZR") || !r.dialect.macro_words) cycle.relative = r.state.relative;
  if (begins || cycle.relative == before) return false;
  const bool keeps_bottom = cycle.bottom && r.sorted.word('Z') == nullptr;
  const bool keeps_retract = cycle.retract && r.sorted.word('R') == nullptr;
  return keeps_bottom || keeps_retract;
}

/// Whether the height is known from which R counts under G91. LinuxCNC and shop controls count from the
/// height at which the series began, other controls perhaps from that of the tool.
bool is_base_known(const Reading& r, bool is_at_initial) {
  const CycleState& cycle = r.state.cycle;
  if (!cycle.relative) return true;
  const bool counts_from_initial = r.dialect.macro_words || r.dialect.family == linuxcnc_family;
  return cycle.initial && (counts_from_initial || is_at_initial);
}

/// The places of the hole are not known: it counts as a feed move of unknown length.
void forget_places(Reading& r, Move& move) {
  move.makes_hole = move.cycle->repeats > 0;
  move.cycle.reset();
  forget_initial(r.state);
}

/// A hole whose heights are not known. It keeps the shift of the block before it.
void forget_heights(const Block& block, Reading& r, Move& move) {
  forget_places(r, move);
  r.state.known[2] = false;
  note_uncorrected(block, r,
                   "R under G91 is a difference from a height that is not known; program Z before the cycle, "
                   "or G90");
}

/// A hole that is not changed.
void fix_hole(Reading& r, Move& move, bool turned) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool depth = axis == 2 && (!r.state.relative || turned);
    const bool other_plane = r.state.normal != 2 && (axis == 2 || static_cast<int>(axis) == r.state.normal);
    if (depth || other_plane || r.sorted.word(letters_of_axes[axis]) != nullptr) fix_axis(r, move, axis);
  }
  forget_places(r, move);
}

/// Without a hole, whether the control moves to X and Y is not known. RS274/NGC refuses zero repeats.
void read_no_holes(const Block& block, Reading& r) {
  if (!r.dialect.macro_words)
    refuse_word(block, r, *r.sorted.word('L'),
                "L0 is not a number of repeats: expected an integer from 1; program Z and R in the first "
                "block with a hole");
  for (std::size_t axis = 0; axis < 2; ++axis)
    if (r.sorted.word(letters_of_axes[axis]) != nullptr) r.state.known[axis] = false;
}

std::string_view why_hole_stays(const Reading& r, bool turned) {
  if (r.state.normal != 2) return "cycles are corrected in G17 only";
  if (plain_words(r) && !repeats_of(r)) return "the count of its repeats is not an integer from 0 to 9999";
  return turned ? "Z and R of an earlier hole are differences under G91 and coordinates under G90"
                : "the cycle's words are not all plain numbers";
}

}  // namespace

void read_cycle(const Block& block, Reading& r) {
  ModalState& state = r.state;
  const std::string_view why = why_not_followed(r);
  const bool begins = begins_series(state);
  const bool turned = turns_sticky_numbers(r, begins);
  const bool base_known = is_base_known(r, state.known[2] && state.position_mm.z() == state.cycle.initial);
  keep_sticky(r, r.sorted.word('Z'), state.cycle.bottom);
  keep_sticky(r, r.sorted.word('R'), state.cycle.retract);

  Move& move = start_move(block, r, Motion::rapid);
  CycleMove hole;
  const std::optional<int> repeats = repeats_of(r);
  hole.repeats = repeats.value_or(1);
  hole.first = is_first(r);
  hole.begins_series = begins;
  hole.initial_mm = state.cycle.initial.value_or(0);
  hole.returns_to_retract = state.returns_to_retract;
  hole.bottom_word = axis_word(r.sorted.word('Z'));
  hole.retract_word = axis_word(r.sorted.word('R'));
  set_levels(state, hole);
  if (hole.repeats > 0)
    place_hole(r, move, hole.repeats, why.empty());
  else
    read_no_holes(block, r);
  const bool followed =
      why.empty() && plain_words(r) && repeats && state.normal == 2 && state.cycle.bottom && !turned;
  if (hole.repeats > 0) set_height_after_hole(state, hole);
  if (r.dialect.keeps_level && !state.level_is_stated && !is_above_start(state, hole)) {
    state.known[2] = false;
    add_remark(r.program, block.line,
               "G98 or G99 is not programmed before this cycle, and the control keeps what a program before "
               "has set: "
               "the height behind the holes is not known; write G98 or G99");
  }
  if (hole.bottom_word || r.sorted.word('Z') != nullptr)
    state.cycle.bottom_unknown = !followed || !empty(block.block_delete);
  hole.may_insert_bottom =
      followed && !state.relative && !state.cycle.relative && !state.cycle.bottom_unknown;
  move.cycle = hole;
  const bool own = !state.relative && state.known[0] && state.known[1] && hole.repeats > 0;
  if (!own) move.handling = Handling::held;
  if (!followed) {
    fix_hole(r, move, turned);
    note_uncorrected(block, r, why.empty() ? why_hole_stays(r, turned) : why);
  } else if (!base_known && hole.repeats > 0) {
    forget_heights(block, r, move);
  }
  finish_move(r, move);
  if (move.block_delete) forget_initial(state);
}

}  // namespace counterflex
