#include "program/write/text_cycle.hpp"

#include "program/dialect.hpp"
#include "program/text/number_style.hpp"

namespace counterflex {
namespace {

/// Reference of a word's number: zero, or under G91 `base_mm`.
double origin(const Move& move, double base_mm) {
  return move.relative ? base_mm : 0;
}

struct Rounded {
  WordNumber number;
  double read_mm = 0;
};

/// The word for `wanted_mm`. In the original the word is for `original_mm` with the reference
/// `original_base_mm`; its reference is now `base_mm`.
Rounded round_from(const Move& move, const AxisWord& word, double original_mm, double original_base_mm,
                   double wanted_mm, double base_mm, const WriteOptions& options) {
  const double unit = mm_per(move.unit);
  const double shown = shown_number(move, word, original_mm - origin(move, original_base_mm));
  const double wanted = (wanted_mm - origin(move, base_mm)) / unit;
  const WordNumber number = round_number(move, word, shown, wanted, Place::end, options);
  const bool untouched = !number.write && !move.relative;
  return {number, untouched ? original_mm : origin(move, base_mm) + number.value * unit};
}

Rounded round_retract(const Move& move, double start_z_mm, double retract_mm, const WriteOptions& options) {
  const CycleMove& cycle = *move.cycle;
  return round_from(move, *cycle.retract_word, cycle.retract_mm, component(move.start_mm, 2), retract_mm,
                    start_z_mm, options);
}

/// A word for a bottom that differs from the sticky one in the text.
WordNumber round_repeated(const Move& move, double repeated_mm, double wanted_mm,
                          const WriteOptions& options) {
  const double unit = mm_per(move.unit);
  const WordNumber number = round_number(move, std::nullopt, 0, wanted_mm / unit, Place::inside, options);
  return rounds_to(repeated_mm / unit, wanted_mm / unit, number.decimals) ? WordNumber{} : number;
}

/// Difference between the written number and that of `original_mm`.
double change_of(const Move& move, const WordNumber& number, double original_mm) {
  return number.write ? number.value * mm_per(move.unit) - original_mm : 0;
}

/// A cycle leaves Z where its series began; or at the retract plane, if that is higher or under G99.
bool is_left_at_retract(const CycleMove& cycle) {
  return cycle.returns_to_retract || cycle.retract_mm >= cycle.initial_mm;
}

}  // namespace

std::optional<double> cycle_initial_after(const Move& move, const TextPosition& before) {
  return move.cycle && move.cycle->begins_series ? before[2] : before.cycle_initial_mm;
}

Coordinate round_cycle_end(const Move& move, const TextPosition& before, double retract_mm,
                           const WriteOptions& options) {
  const CycleMove& cycle = *move.cycle;
  if (!move.known_end[2]) return {{}, std::nullopt};
  if (cycle.repeats == 0) return {{}, before[2]};
  const std::optional<double> initial_mm = cycle_initial_after(move, before);
  if (!is_left_at_retract(cycle)) return {{}, initial_mm};
  if (!cycle.retract_word) return {{}, before[2]};
  const double z_mm = before[2].value_or(component(move.start_mm, 2));
  const double read_mm = round_retract(move, z_mm, retract_mm, options).read_mm;
  return {{}, cycle.returns_to_retract ? read_mm : std::max(read_mm, initial_mm.value_or(read_mm))};
}

CycleWords round_cycle(const Move& move, std::optional<double> start_z_mm, std::optional<double> bottom_mm,
                       std::optional<double> retract_mm, WrittenCycle& written, const WriteOptions& options) {
  const CycleMove& cycle = *move.cycle;
  CycleWords words;
  // Differences from an unknown height are not changed.
  if (move.relative && !start_z_mm) {
    keep_cycle(cycle, written);
    return words;
  }
  if (cycle.retract_word) {
    const double z_mm = start_z_mm.value_or(component(move.start_mm, 2));
    const Rounded retract = round_retract(move, z_mm, retract_mm.value_or(cycle.retract_mm), options);
    words.retract = retract.number;
    written.retract_change_mm = retract.read_mm - cycle.retract_mm;
  }
  if (cycle.bottom_word) {
    const Rounded bottom = round_from(move, *cycle.bottom_word, cycle.bottom_mm, cycle.retract_mm,
                                      bottom_mm.value_or(cycle.bottom_mm),
                                      cycle.retract_mm + written.retract_change_mm, options);
    words.bottom = bottom.number;
    written.bottom_change_mm =
        change_of(move, bottom.number, cycle.bottom_mm - origin(move, cycle.retract_mm));
  } else if (bottom_mm && cycle.may_insert_bottom && !move.relative) {
    words.bottom = round_repeated(move, cycle.bottom_mm + written.bottom_change_mm, *bottom_mm, options);
    if (words.bottom.write) written.bottom_change_mm = change_of(move, words.bottom, cycle.bottom_mm);
  }
  if (move.block_delete) written = {};
  return words;
}

void keep_cycle(const CycleMove& cycle, WrittenCycle& written) {
  if (cycle.bottom_word) written.bottom_change_mm = 0;
  if (cycle.retract_word) written.retract_change_mm = 0;
}

}  // namespace counterflex
