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

/// Where the text holds an axis, if that is known. An optional would be kept in memory and waited for.
struct Held {
  bool known = false;
  double mm = 0;
};

Held held_of(const std::optional<double>& held_mm) {
  return held_mm ? Held{true, *held_mm} : Held{};
}

struct SettledAxis {
  WordNumber number;
  Held held;
};

/// The word as it stands.
SettledAxis keep(const Move& move, std::size_t axis, Held held) {
  const AxisWord word = *move.words[axis];
  const int decimals = decimals_of_kept(move, word.decimals);
  const double end_mm = component(move.end_mm, axis);
  if (!move.relative) return {{false, in_unit(end_mm, move.unit), decimals}, {true, end_mm}};
  const double way_mm = (end_mm - component(move.start_mm, axis)) / times(move);
  const double value = shown_number(move, word, way_mm);
  held.mm += times(move) * (value * mm_per(move.unit));
  return {{false, value, decimals}, held};
}

/// A word written anew. Under G91 it says how far it is from where the text holds the axis, so that rounding
/// never adds up.
SettledAxis write_anew(const Move& move, Held held, double wanted_mm, int decimals) {
  const double unit = mm_per(move.unit);
  const double wanted = move.relative ? (wanted_mm - held.mm) / times(move) : wanted_mm;
  const double value = rounded(in_unit(wanted, move.unit), decimals);
  const double read_mm = move.relative ? held.mm + times(move) * (value * unit) : value * unit;
  return {{true, value, decimals}, {true, read_mm}};
}

/// Whether writing `wanted_mm` anew would be no more exact than where the axis is.
bool is_near(const Move& move, const Held& held, double wanted_mm, int decimals) {
  return rounds_to(in_unit(held.mm, move.unit), in_unit(wanted_mm, move.unit), decimals);
}

SettledAxis settle_absent(const Move& move, std::size_t axis, Held held, double wanted_mm, Place place,
                          const WriteOptions& options) {
  if (move.ignored[axis]) return {{}, held};
  if (!move.known_end[axis]) return {};
  if (place != Place::inside && !move.may_insert_words) return {{}, held};
  const int decimals = decimals_of_word(move, no_decimals, place, options);
  if (held.known ? is_near(move, held, wanted_mm, decimals) : move.relative) return {{}, held};
  return write_anew(move, held, wanted_mm, decimals);
}

SettledAxis settle_present(const Move& move, std::size_t axis, Held held, double wanted_mm, Place place,
                           const WriteOptions& options) {
  const int decimals = decimals_of_word(move, decimals_shown(move.words[axis]), place, options);
  SettledAxis settled = keep(move, axis, held);
  if (settled.held.known && !is_near(move, settled.held, wanted_mm, decimals))
    settled = write_anew(move, held, wanted_mm, decimals);
  settled.held.known = settled.held.known && move.known_end[axis];
  return settled;
}

SettledAxis settle_plain(const Move& move, std::size_t axis, Held held, double wanted_mm, Place place,
                         const WriteOptions& options) {
  if (move.fixed[axis]) return {{}, {move.known_end[axis], component(move.end_mm, axis)}};
  if (!move.words[axis] || place == Place::inside)
    return settle_absent(move, axis, held, wanted_mm, place, options);
  return settle_present(move, axis, held, wanted_mm, place, options);
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

Coordinate settle_axis(const Move& move, std::size_t axis, const std::optional<double>& held_mm,
                       double wanted_mm, Place place, const WriteOptions& options) {
  if (move.cycle && axis == 2) return settle_cycle_end(move, held_mm, wanted_mm, options);
  const SettledAxis settled = settle_plain(move, axis, held_of(held_mm), wanted_mm, place, options);
  Coordinate c{settled.number, {}};
  if (settled.held.known) c.held_mm = settled.held.mm;
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
      const Held kept = keep(move, axis, held_of(start[axis])).held;
      held[axis] = kept.known ? std::optional(kept.mm) : std::nullopt;
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
