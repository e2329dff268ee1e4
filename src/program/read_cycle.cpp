#include "program/read_cycle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/read_move.hpp"

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

/// L, or K of shop controls; 1 where there is none.
int repeats_of(const Reading& r) {
  const Word* word = r.sorted.word('L');
  if (word == nullptr && r.dialect.macro_words) word = r.sorted.word('K');
  if (word == nullptr) return 1;
  return word->literal && word->value >= 0 && word->value < 10000 ? static_cast<int>(word->value) : 1;
}

bool plain_words(const Reading& r) {
  for (const char letter : {'X', 'Y', 'Z', 'R', 'L', 'K'})
    if (const Word* word = r.sorted.word(letter); word != nullptr && !word->literal) return false;
  return true;
}

/// Z of the retract plane and of the bottom. Without R the tool comes back to where it began.
void set_levels(const ModalState& state, CycleMove& hole) {
  const CycleState& cycle = state.cycle;
  const double initial = cycle.initial.value_or(0);
  hole.retract_mm = cycle.retract ? *cycle.retract + (cycle.relative ? initial : 0) : initial;
  hole.bottom_mm = cycle.bottom.value_or(hole.retract_mm) + (cycle.relative ? hole.retract_mm : 0);
}

/// Where the cycle leaves the tool along Z.
void leave_hole(ModalState& state, const CycleMove& hole) {
  const CycleState& cycle = state.cycle;
  const bool retract_known = cycle.retract ? !cycle.relative || cycle.initial : cycle.initial.has_value();
  if (hole.returns_to_retract) {
    state.known[2] = retract_known;
    state.position_mm.z() = hole.retract_mm;
  } else {
    // A hole that is not followed, or another work offset, has lost the height where the series began.
    state.known[2] = state.known[2] && cycle.initial && retract_known;
    state.position_mm.z() = std::max(cycle.initial.value_or(0), hole.retract_mm);
  }
}

/// X and Y; relative ones are repeated.
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

void begin_series(ModalState& state) {
  if (state.cycle.begun) return;
  state.cycle.begun = true;
  if (state.known[2]) state.cycle.initial = state.position_mm.z();
}

/// A hole that stays as the text has it.
void fix_hole(Reading& r, Move& move) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool depth = axis == 2 && !r.state.relative;
    if (depth || r.sorted.word(letters_of_axes[axis]) != nullptr) fix_axis(r, move, axis);
  }
  move.cycle.reset();
}

}  // namespace

void read_cycle(const Block& block, Reading& r) {
  ModalState& state = r.state;
  const std::string_view why = why_not_followed(r);
  begin_series(state);
  // Shop controls keep the depth that was programmed under G90 also where G91 moves on to further holes.
  if (is_first(r) || r.sorted.has_any("ZR") || !r.dialect.macro_words) state.cycle.relative = state.relative;
  keep_sticky(r, r.sorted.word('Z'), state.cycle.bottom);
  keep_sticky(r, r.sorted.word('R'), state.cycle.retract);

  Move& move = start_move(block, r, Motion::rapid);
  CycleMove hole;
  hole.repeats = repeats_of(r);
  hole.first = is_first(r);
  hole.returns_to_retract = state.returns_to_retract;
  hole.bottom_word = axis_word(r.sorted.word('Z'));
  hole.retract_word = axis_word(r.sorted.word('R'));
  set_levels(state, hole);
  if (hole.repeats > 0) place_hole(r, move, hole.repeats, why.empty());
  const bool followed = why.empty() && plain_words(r) && state.normal == 2 && state.cycle.bottom;
  if (hole.repeats > 0) leave_hole(state, hole);
  if (hole.bottom_word || r.sorted.word('Z') != nullptr)
    state.cycle.bottom_in_doubt = !followed || !empty(block.block_delete);
  hole.may_insert_bottom =
      followed && !state.relative && !state.cycle.relative && !state.cycle.bottom_in_doubt;
  move.cycle = hole;
  const bool own = !state.relative && state.known[0] && state.known[1] && hole.repeats > 0;
  if (!own) move.handling = Handling::held;
  if (!followed) {
    fix_hole(r, move);
    leave_alone(block, r, why.empty() ? "the cycle's words are not all plain numbers in G17" : why);
  }
  finish_move(r, move);
}

}  // namespace counterflex
