#include "program/write/held_position.hpp"

#include <algorithm>
#include <cmath>

#include "counterflex/files/numbers.hpp"
#include "program/dialect.hpp"
#include "program/write/held_cycle.hpp"
#include "program/text/number_style.hpp"
#include "program/write/step.hpp"

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

// The functions below fill the coordinate where it is to stand: a copy would wait for what was just stored.

/// The word as it stands.
void keep(const Move& move, std::size_t axis, const std::optional<double>& held_mm, Coordinate& c) {
  const AxisWord word = *move.words[axis];
  const double end_mm = component(move.end_mm, axis);
  c.number.decimals = decimals_of_kept(move, word.decimals);
  if (!is_relative(move, axis)) {
    c.number.value = in_unit(end_mm, move.unit);
    c.held_mm = end_mm;
    return;
  }
  const double way_mm = (end_mm - component(move.start_mm, axis)) / times(move);
  c.number.value = shown_number(move, word, way_mm);
  if (held_mm) c.held_mm = *held_mm + times(move) * (c.number.value * mm_per(move.unit));
}

/// A word written anew. Under G91 it says how far it is from where the text holds the axis, so that rounding
/// never adds up.
void write_anew(const Move& move, std::size_t axis, const std::optional<double>& held_mm, double wanted_mm,
                int decimals, Coordinate& c) {
  const bool relative = is_relative(move, axis);
  const double unit = mm_per(move.unit);
  const double wanted = relative ? (wanted_mm - *held_mm) / times(move) : wanted_mm;
  const double value = rounded(in_unit(wanted, move.unit), decimals);
  c.number.write = true;
  c.number.value = value;
  c.number.decimals = decimals;
  c.held_mm = relative ? *held_mm + times(move) * (value * unit) : value * unit;
}

/// Whether writing `wanted_mm` anew would be no more exact than `held_mm`.
bool is_near(const Move& move, double held_mm, double wanted_mm, int decimals) {
  return rounds_to(in_unit(held_mm, move.unit), in_unit(wanted_mm, move.unit), decimals);
}

void settle_absent(const Move& move, std::size_t axis, const std::optional<double>& held_mm, double wanted_mm,
                   Place place, const WriteOptions& options, Coordinate& c) {
  if (!move.known_end[axis] && !move.ignored[axis]) return;
  assign(c.held_mm, held_mm);
  if (move.ignored[axis] || (place != Place::inside && !may_insert_word(move, axis))) return;
  const int decimals = decimals_of_word(move, no_decimals, place, options);
  if (held_mm ? is_near(move, *held_mm, wanted_mm, decimals) : is_relative(move, axis)) return;
  write_anew(move, axis, held_mm, wanted_mm, decimals, c);
}

void settle_present(const Move& move, std::size_t axis, const std::optional<double>& held_mm,
                    double wanted_mm, Place place, const WriteOptions& options, Coordinate& c) {
  const int decimals = decimals_of_word(move, decimals_shown(move.words[axis]), place, options);
  keep(move, axis, held_mm, c);
  if (c.held_mm && !is_near(move, *c.held_mm, wanted_mm, decimals))
    write_anew(move, axis, held_mm, wanted_mm, decimals, c);
  if (!move.known_end[axis]) c.held_mm.reset();
}

}  // namespace

WordNumber settle_number(const Move& move, const PackedAxisWord& word, double original, double wanted,
                         Place place, const WriteOptions& options) {
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

Coordinate settle_axis(const Move& move, std::size_t axis, const HeldPosition& before, double wanted_mm,
                       Place place, const WriteOptions& options) {
  if (move.cycle && axis == 2) return settle_cycle_end(move, before, wanted_mm, options);
  Coordinate c;
  if (move.fixed[axis]) {
    if (move.known_end[axis]) c.held_mm = component(move.end_mm, axis);
  } else if (!move.words[axis] || place == Place::inside) {
    settle_absent(move, axis, before[axis], wanted_mm, place, options, c);
  } else {
    settle_present(move, axis, before[axis], wanted_mm, place, options, c);
  }
  return c;
}

HeldPosition held_at_start(const Move& move, const HeldPosition& before) {
  HeldPosition held;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (move.known_start[axis]) assign(held[axis], before[axis]);
  assign(held.cycle_initial_mm, before.cycle_initial_mm);
  return held;
}

HeldPosition held_between(const Move& last, const Move& next, const HeldPosition& held) {
  HeldPosition moved = held;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double change_mm = component(next.start_mm, axis) - component(last.end_mm, axis);
    const bool known = last.known_end[axis] && next.known_start[axis] && !next.ignored[axis];
    if (known && moved[axis] && change_mm != 0) *moved[axis] += change_mm;
    if (axis == 2 && change_mm != 0) moved.cycle_initial_mm.reset();
  }
  return moved;
}

HeldPosition held_after_original(const Move& move, const HeldPosition& before) {
  const HeldPosition start = held_at_start(move, before);
  HeldPosition held = start;
  held.cycle_initial_mm = cycle_initial_after(move, start);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double end_mm = component(move.end_mm, axis);
    if (!move.known_end[axis] || move.fixed[axis]) {
      held[axis] = move.known_end[axis] ? std::optional(end_mm) : std::nullopt;
    } else if (move.cycle && axis == 2) {
      held[axis] = settle_cycle_end(move, start, move.cycle->retract_mm, {}).held_mm;
    } else if (move.words[axis]) {
      Coordinate kept;
      keep(move, axis, start[axis], kept);
      held[axis] = kept.held_mm;
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

namespace {

/// Whether a word says where the axis goes, and nothing else does.
bool is_said(const Move& move, std::size_t axis) {
  return move.words[axis] && move.known_end[axis] && !is_relative(move, axis) && !move.fixed[axis] &&
         !(move.cycle && axis == 2);
}

/// What `settle_axis` says of the position of such an axis, nearly all there are.
double held_by_word(const Move& move, std::size_t axis, double wanted_mm, const WriteOptions& options) {
  const double end_mm = component(move.end_mm, axis), wanted = in_unit(wanted_mm, move.unit);
  const int decimals = decimals_of_word(move, decimals_shown(move.words[axis]), Place::end, options);
  if (rounds_to(in_unit(end_mm, move.unit), wanted, decimals)) return end_mm;
  return rounded(wanted, decimals) * mm_per(move.unit);
}

}  // namespace

HeldPosition held_after(const Move& move, const HeldPosition& before, const Vector3& end_mm,
                        const WriteOptions& options) {
  const HeldPosition start = held_at_start(move, before);
  HeldPosition held;
  if (move.angle_axis != 0) {
    held = settle_step(move, start, {end_mm}, motion_of(move), Place::end, options).after;
    doubt_skippable(move, start, held);
    return held;
  }
  held.cycle_initial_mm = cycle_initial_after(move, start);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double wanted_mm = component(end_mm, axis);
    if (is_said(move, axis))
      held[axis] = held_by_word(move, axis, wanted_mm, options);
    else
      held[axis] = settle_axis(move, axis, start, wanted_mm, Place::end, options).held_mm;
  }
  doubt_skippable(move, start, held);
  return held;
}

Decimals decimals_of(const Move& move, const WriteOptions& options) {
  const int least = decimals_of_word(move, no_decimals, Place::inside, options);
  Decimals decimals{{least, least, least}, least};
  if (options.decimals >= 0) return decimals;
  for (std::size_t axis = 0; axis < 3; ++axis)
    decimals.end[axis] = std::max(least, decimals_shown(move.words[axis]));
  return decimals;
}

Vector3 as_written_mm(const Vector3& p_mm, LengthUnit unit, const std::array<int, 3>& decimals) {
  Vector3 p;
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    p[axis] = rounded(p_mm[axis] / mm_per(unit), decimals[static_cast<std::size_t>(axis)]) * mm_per(unit);
  return p;
}

}  // namespace counterflex
