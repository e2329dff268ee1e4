#include "program/write/held_cycle.hpp"

#include "program/dialect.hpp"
#include "program/text/number_style.hpp"

namespace counterflex {
namespace {

/// Where a word's number counts from: zero, or under G91 `base_mm`.
double origin(const Move& move, double base_mm) {
  return move.relative ? base_mm : 0;
}

struct Settled {
  WordNumber number;
  double read_mm = 0;
};

/// The word that brings what stood at `original_mm` to `wanted_mm`; it counted from `original_base_mm` and
/// now counts from `base_mm`.
Settled settle_from(const Move& move, const AxisWord& word, double original_mm, double original_base_mm,
                    double wanted_mm, double base_mm, const WriteOptions& options) {
  const double unit = mm_per(move.unit);
  const double shown = shown_number(move, word, original_mm - origin(move, original_base_mm));
  const double wanted = (wanted_mm - origin(move, base_mm)) / unit;
  const WordNumber number = settle_number(move, word, shown, wanted, Place::end, options);
  const bool untouched = !number.write && !move.relative;
  return {number, untouched ? original_mm : origin(move, base_mm) + number.value * unit};
}

Settled settle_retract(const Move& move, double held_z_mm, double retract_mm, const WriteOptions& options) {
  const CycleMove& cycle = *move.cycle;
  return settle_from(move, *cycle.retract_word, cycle.retract_mm, component(move.start_mm, 2), retract_mm,
                     held_z_mm, options);
}

/// A word for a bottom that the text does not repeat already.
WordNumber settle_repeated(const Move& move, double repeated_mm, double wanted_mm,
                           const WriteOptions& options) {
  const double unit = mm_per(move.unit);
  const WordNumber number = settle_number(move, std::nullopt, 0, wanted_mm / unit, Place::inside, options);
  return rounds_to(repeated_mm / unit, wanted_mm / unit, number.decimals) ? WordNumber{} : number;
}

/// How far the number that is written lies from the one that said `original_mm`.
double change_of(const Move& move, const WordNumber& number, double original_mm) {
  return number.write ? number.value * mm_per(move.unit) - original_mm : 0;
}

/// A cycle leaves Z where its series began, or at the retract plane where that is higher or G99 says so.
bool is_left_at_retract(const CycleMove& cycle) {
  return cycle.returns_to_retract || cycle.retract_mm >= cycle.initial_mm;
}

}  // namespace

std::optional<double> cycle_initial_after(const Move& move, const HeldPosition& before) {
  return move.cycle && move.cycle->begins_series ? before[2] : before.cycle_initial_mm;
}

Coordinate settle_cycle_end(const Move& move, const HeldPosition& before, double retract_mm,
                            const WriteOptions& options) {
  const CycleMove& cycle = *move.cycle;
  if (!move.known_end[2]) return {{}, std::nullopt};
  if (cycle.repeats == 0) return {{}, before[2]};
  const std::optional<double> initial_mm = cycle_initial_after(move, before);
  if (!is_left_at_retract(cycle)) return {{}, initial_mm};
  if (!cycle.retract_word) return {{}, before[2]};
  const double z_mm = before[2].value_or(component(move.start_mm, 2));
  const double read_mm = settle_retract(move, z_mm, retract_mm, options).read_mm;
  return {{}, cycle.returns_to_retract ? read_mm : std::max(read_mm, initial_mm.value_or(read_mm))};
}

CycleWords settle_cycle(const Move& move, std::optional<double> held_z_mm, std::optional<double> bottom_mm,
                        std::optional<double> retract_mm, HeldCycle& held, const WriteOptions& options) {
  const CycleMove& cycle = *move.cycle;
  CycleWords words;
  // Differences from a height that nobody knows stay as they are.
  if (move.relative && !held_z_mm) {
    pass_cycle(cycle, held);
    return words;
  }
  if (cycle.retract_word) {
    const double z_mm = held_z_mm.value_or(component(move.start_mm, 2));
    const Settled retract = settle_retract(move, z_mm, retract_mm.value_or(cycle.retract_mm), options);
    words.retract = retract.number;
    held.retract_change_mm = retract.read_mm - cycle.retract_mm;
  }
  if (cycle.bottom_word) {
    const Settled bottom =
        settle_from(move, *cycle.bottom_word, cycle.bottom_mm, cycle.retract_mm,
                    bottom_mm.value_or(cycle.bottom_mm), cycle.retract_mm + held.retract_change_mm, options);
    words.bottom = bottom.number;
    held.bottom_change_mm = change_of(move, bottom.number, cycle.bottom_mm - origin(move, cycle.retract_mm));
  } else if (bottom_mm && cycle.may_insert_bottom && !move.relative) {
    words.bottom = settle_repeated(move, cycle.bottom_mm + held.bottom_change_mm, *bottom_mm, options);
    if (words.bottom.write) held.bottom_change_mm = change_of(move, words.bottom, cycle.bottom_mm);
  }
  if (move.block_delete) held = {};
  return words;
}

void pass_cycle(const CycleMove& cycle, HeldCycle& held) {
  if (cycle.bottom_word) held.bottom_change_mm = 0;
  if (cycle.retract_word) held.retract_change_mm = 0;
}

}  // namespace counterflex
