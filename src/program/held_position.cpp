#include "program/held_position.hpp"

#include <algorithm>
#include <cmath>

#include "counterflex/files/numbers.hpp"
#include "program/dialect.hpp"
#include "program/held_cycle.hpp"
#include "program/number_style.hpp"

namespace counterflex {
namespace {

constexpr int no_decimals = -1;

/// Digits of a word that shows `shown` of them, or of one that is inserted.
int decimals_of_word(const Move& move, int shown, Place place, const WriteOptions& options) {
  if (options.decimals >= 0) return options.decimals;
  const int resolution = resolution_decimals(move.unit);
  return place == Place::end ? std::max(resolution, shown) : resolution;
}

int decimals_of_kept(const Move& move, int shown) {
  return std::max(shown, resolution_decimals(move.unit));
}

int decimals_shown(const PackedAxisWord& word) {
  return word ? (*word).decimals : no_decimals;
}

/// How often a relative word is gone.
int times(const Move& move) {
  return move.cycle ? std::max(move.cycle->repeats, 1) : 1;
}

/// The word as it stands.
Coordinate keep(const Move& move, std::size_t axis, std::optional<double> held_mm) {
  const AxisWord word = *move.words[axis];
  const int decimals = decimals_of_kept(move, word.decimals);
  const double end_mm = component(move.end_mm, axis);
  if (!move.relative) return {{false, in_unit(end_mm, move.unit), decimals}, end_mm};
  const double way_mm = (end_mm - component(move.start_mm, axis)) / times(move);
  const double value = shown_number(move, word, way_mm);
  if (held_mm) *held_mm += times(move) * (value * mm_per(move.unit));
  return {{false, value, decimals}, held_mm};
}

/// Where the text holds the axis after the word as it stands.
std::optional<double> held_if_kept(const Move& move, std::size_t axis, std::optional<double> held_mm) {
  if (!move.relative) return component(move.end_mm, axis);
  return keep(move, axis, held_mm).held_mm;
}

/// A word written anew. Under G91 it says how far it is from where the text holds the axis, so that rounding
/// never adds up.
Coordinate write_anew(const Move& move, std::optional<double> held_mm, double wanted_mm, int decimals) {
  const double unit = mm_per(move.unit);
  const double wanted = move.relative ? (wanted_mm - *held_mm) / times(move) : wanted_mm;
  const double value = rounded(in_unit(wanted, move.unit), decimals);
  const double read_mm = move.relative ? *held_mm + times(move) * (value * unit) : value * unit;
  return {{true, value, decimals}, read_mm};
}

Coordinate settle_absent(const Move& move, std::size_t axis, std::optional<double> held_mm, double wanted_mm,
                         Place place, const WriteOptions& options) {
  if (move.ignored[axis]) return {{}, held_mm};
  if (!move.known_end[axis]) return {{}, std::nullopt};
  if (place != Place::inside && !move.may_insert_words) return {{}, held_mm};
  const int decimals = decimals_of_word(move, no_decimals, place, options);
  if (held_mm && rounds_to(in_unit(*held_mm, move.unit), in_unit(wanted_mm, move.unit), decimals))
    return {{}, held_mm};
  if (move.relative && !held_mm) return {{}, held_mm};
  return write_anew(move, held_mm, wanted_mm, decimals);
}

Coordinate settle_present(const Move& move, std::size_t axis, std::optional<double> held_mm, double wanted_mm,
                          Place place, const WriteOptions& options) {
  const int decimals = decimals_of_word(move, decimals_shown(move.words[axis]), place, options);
  const std::optional<double> kept_mm = held_if_kept(move, axis, held_mm);
  if (!kept_mm || rounds_to(in_unit(*kept_mm, move.unit), in_unit(wanted_mm, move.unit), decimals))
    return keep(move, axis, held_mm);
  return write_anew(move, held_mm, wanted_mm, decimals);
}

}  // namespace

WordNumber settle_number(const Move& move, const std::optional<AxisWord>& word, double original,
                         double wanted, Place place, const WriteOptions& options) {
  const int decimals = decimals_of_word(move, word ? word->decimals : no_decimals, place, options);
  if (word && rounds_to(original, wanted, decimals))
    return {false, original, decimals_of_kept(move, word->decimals)};
  return {true, rounded(wanted, decimals), decimals};
}

double shown_number(const Move& move, const AxisWord& word, double length_mm) {
  // What is computed from differences is exact to far more digits than a word has, but not to the last bit.
  constexpr int digits_that_difference_keeps = 9;
  const int decimals = std::max(word.decimals, resolution_decimals(move.unit));
  const double value = length_mm / mm_per(move.unit);
  if (decimals > digits_that_difference_keeps) return value;
  // A whole number over a power of ten is the very number that its text is read as.
  return std::round(value * power_of_ten(decimals)) / power_of_ten(decimals);
}

Coordinate settle_axis(const Move& move, std::size_t axis, std::optional<double> held_mm, double wanted_mm,
                       Place place, const WriteOptions& options) {
  if (move.cycle && axis == 2) return settle_cycle_end(move, held_mm, wanted_mm, options);
  if (move.fixed[axis])
    return {{}, move.known_end[axis] ? std::optional(component(move.end_mm, axis)) : std::nullopt};
  if (!move.words[axis] || place == Place::inside)
    return settle_absent(move, axis, held_mm, wanted_mm, place, options);
  Coordinate c = settle_present(move, axis, held_mm, wanted_mm, place, options);
  if (!move.known_end[axis]) c.held_mm.reset();
  return c;
}

HeldPosition held_at_start(const Move& move, HeldPosition before) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!move.known_start[axis]) before[axis].reset();
  return before;
}

HeldPosition held_between(const Move& last, const Move& next, const HeldPosition& held) {
  if (next.start_mm == last.end_mm) return held;
  HeldPosition moved = held;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double change_mm = component(next.start_mm, axis) - component(last.end_mm, axis);
    const bool known = last.known_end[axis] && next.known_start[axis] && !next.ignored[axis];
    if (known && moved[axis] && change_mm != 0) *moved[axis] += change_mm;
  }
  return moved;
}

HeldPosition held_after_original(const Move& move, const HeldPosition& before) {
  const HeldPosition start = held_at_start(move, before);
  HeldPosition held = start;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double end_mm = component(move.end_mm, axis);
    if (!move.known_end[axis] || move.fixed[axis]) {
      held[axis] = move.known_end[axis] ? std::optional(end_mm) : std::nullopt;
    } else if (move.cycle && axis == 2) {
      held[axis] = settle_cycle_end(move, start[axis], move.cycle->retract_mm, {}).held_mm;
    } else if (move.words[axis]) {
      held[axis] = held_if_kept(move, axis, start[axis]);
    }
  }
  doubt_skippable(move, start, held);
  return held;
}

void doubt_skippable(const Move& move, const HeldPosition& before, HeldPosition& held) {
  if (!move.block_delete) return;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (move.words[axis] || before[axis] != held[axis]) held[axis].reset();
}

HeldPosition held_after(const Move& move, const HeldPosition& before, const Vector3& end_mm,
                        const WriteOptions& options) {
  const HeldPosition start = held_at_start(move, before);
  HeldPosition held;
  for (std::size_t axis = 0; axis < 3; ++axis)
    held[axis] = settle_axis(move, axis, start[axis], component(end_mm, axis), Place::end, options).held_mm;
  doubt_skippable(move, start, held);
  return held;
}

Decimals decimals_of(const Move& move, const WriteOptions& options) {
  Decimals decimals{};
  decimals.inserted = decimals_of_word(move, no_decimals, Place::inside, options);
  for (std::size_t axis = 0; axis < 3; ++axis)
    decimals.end[axis] = decimals_of_word(move, decimals_shown(move.words[axis]), Place::end, options);
  return decimals;
}

Vector3 as_written_mm(const Vector3& p_mm, LengthUnit unit, const std::array<int, 3>& decimals) {
  Vector3 p;
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    p[axis] = rounded(p_mm[axis] / mm_per(unit), decimals[static_cast<std::size_t>(axis)]) * mm_per(unit);
  return p;
}

}  // namespace counterflex
