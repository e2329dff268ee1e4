#include "program/write/text_position.hpp"

#include <algorithm>
#include <cmath>

#include "counterflex/files/text.hpp"
#include "program/dialect.hpp"
#include "program/text/number_style.hpp"
#include "program/write/step.hpp"
#include "program/write/text_cycle.hpp"

namespace counterflex {
namespace {

constexpr int no_decimals = -1;

/// Digits of the numbers of an orientation: half of the last one is a 400th of the tolerance of tilt, or
/// less.
constexpr int orientation_decimals(OrientationForm form) {
  switch (form) {
    case OrientationForm::quaternion:
      return quaternion_decimals;
    case OrientationForm::rotation_vector:
    case OrientationForm::axis:
      return 6;  // rad
    case OrientationForm::fixed_axes:
      break;
  }
  return 4;  // deg
}

/// Digits of a word that has `shown` digits, or of an inserted word.
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

/// Number of times that a relative word is applied.
int times(const Move& move) {
  return move.cycle ? std::max(move.cycle->repeats, 1) : 1;
}

// The functions below fill the coordinate in place: a copy would wait for the stores.

/// The unchanged word.
void keep(const Move& move, std::size_t axis, const std::optional<double>& position_mm, Coordinate& c) {
  const AxisWord word = *move.words[axis];
  const double end_mm = component(move.end_mm, axis);
  c.number.decimals = decimals_of_kept(move, word.decimals);
  if (!is_relative(move, axis)) {
    c.number.value = in_unit(end_mm, move.unit);
    c.position_mm = end_mm;
    return;
  }
  const double way_mm = (end_mm - component(move.start_mm, axis)) / times(move);
  c.number.value = shown_number(move, word, way_mm);
  if (position_mm) c.position_mm = *position_mm + times(move) * (c.number.value * mm_per(move.unit));
}

/// A new word. Under G91 it is the difference from the position in the text, so that rounding errors do not
/// add up.
void write_new(const Move& move, std::size_t axis, const std::optional<double>& position_mm, double wanted_mm,
               int decimals, Coordinate& c) {
  const bool relative = is_relative(move, axis);
  const double unit = mm_per(move.unit);
  const double wanted = relative ? (wanted_mm - *position_mm) / times(move) : wanted_mm;
  const double value = rounded(in_unit(wanted, move.unit), decimals);
  c.number.write = true;
  c.number.value = value;
  c.number.decimals = decimals;
  c.position_mm = relative ? *position_mm + times(move) * (value * unit) : value * unit;
}

/// Whether a new word for `wanted_mm` would not be more exact than `position_mm`.
bool is_near(const Move& move, double position_mm, double wanted_mm, int decimals) {
  return rounds_to(in_unit(position_mm, move.unit), in_unit(wanted_mm, move.unit), decimals);
}

void round_absent(const Move& move, std::size_t axis, const std::optional<double>& position_mm,
                  double wanted_mm, Place place, const WriteOptions& options, Coordinate& c) {
  if (!move.known_end[axis] && !move.ignored[axis]) return;
  assign(c.position_mm, position_mm);
  if (move.ignored[axis] || (place != Place::inside && !may_insert_word(move, axis))) return;
  const int decimals = decimals_of_word(move, no_decimals, place, options);
  if (position_mm ? is_near(move, *position_mm, wanted_mm, decimals) : is_relative(move, axis)) return;
  write_new(move, axis, position_mm, wanted_mm, decimals, c);
}

void round_present(const Move& move, std::size_t axis, const std::optional<double>& position_mm,
                   double wanted_mm, Place place, const WriteOptions& options, Coordinate& c) {
  const int decimals = decimals_of_word(move, decimals_shown(move.words[axis]), place, options);
  keep(move, axis, position_mm, c);
  if (c.position_mm && !is_near(move, *c.position_mm, wanted_mm, decimals))
    write_new(move, axis, position_mm, wanted_mm, decimals, c);
  if (!move.known_end[axis]) c.position_mm.reset();
}

}  // namespace

WordNumber round_number(const Move& move, const PackedAxisWord& word, double original, double wanted,
                        Place place, const WriteOptions& options) {
  const int decimals = decimals_of_word(move, word ? word->decimals : no_decimals, place, options);
  if (word && rounds_to(original, wanted, decimals))
    return {false, original, decimals_of_kept(move, word->decimals)};
  return {true, rounded(wanted, decimals), decimals};
}

double shown_number(const Move& move, const AxisWord& word, double length_mm) {
  // Rounding errors of differences are far below the last digit of a word, but not zero.
  constexpr int digits_that_difference_keeps = 9;
  const int decimals = std::max(word.decimals, resolution_decimals(move.unit));
  const double value = length_mm / mm_per(move.unit);
  if (decimals > digits_that_difference_keeps) return value;
  // An integer divided by a power of ten is the number that is read from its text.
  return std::round(value * power_of_ten(decimals)) / power_of_ten(decimals);
}

Coordinate round_axis(const Move& move, std::size_t axis, const TextPosition& before, double wanted_mm,
                      Place place, const WriteOptions& options) {
  if (move.cycle && axis == 2) return round_cycle_end(move, before, wanted_mm, options);
  Coordinate c;
  if (move.fixed[axis]) {
    if (move.known_end[axis]) c.position_mm = component(move.end_mm, axis);
  } else if (!move.words[axis] || place == Place::inside) {
    round_absent(move, axis, before[axis], wanted_mm, place, options, c);
  } else {
    round_present(move, axis, before[axis], wanted_mm, place, options, c);
  }
  return c;
}

WordNumber round_angle(const Move& move, std::size_t i, const TextPosition& before, double wanted,
                       Place place) {
  const MoveOrientation& orientation = *move.orientation;
  const PackedAxisWord& word = orientation.words[i];
  const int angle_decimals = orientation_decimals(orientation.form);
  if (word && place != Place::inside) {
    const int decimals = std::max(angle_decimals, word->decimals);
    if (rounds_to(orientation.end[i], wanted, decimals)) return {false, orientation.end[i], decimals};
    return {true, rounded(wanted, decimals), decimals};
  }
  if (before.orientation && rounds_to((*before.orientation)[i], wanted, angle_decimals))
    return {false, (*before.orientation)[i], angle_decimals};
  return {true, rounded(wanted, angle_decimals), angle_decimals};
}

TextPosition known_text_position(const Move& move, const TextPosition& before) {
  TextPosition position;
  position.orientation = before.orientation;
  if (move.starts_uncorrected && move.orientation) position.orientation = move.orientation->start;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (move.starts_uncorrected)
      position[axis] = component(move.start_mm, axis);
    else if (move.known_start[axis])
      assign(position[axis], before[axis]);
  assign(position.cycle_initial_mm, before.cycle_initial_mm);
  return position;
}

TextPosition text_position_between(const Move& last, const Move& next, const TextPosition& position) {
  if (next.starts_uncorrected) return known_text_position(next, position);
  TextPosition moved = position;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double change_mm = component(next.start_mm, axis) - component(last.end_mm, axis);
    const bool known = last.known_end[axis] && next.known_start[axis] && !next.ignored[axis];
    if (known && moved[axis] && change_mm != 0) *moved[axis] += change_mm;
    if (axis == 2 && change_mm != 0) moved.cycle_initial_mm.reset();
  }
  return moved;
}

TextPosition text_position_after_original(const Move& move, const TextPosition& before) {
  const TextPosition start = known_text_position(move, before);
  TextPosition position = start;
  position.cycle_initial_mm = cycle_initial_after(move, start);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double end_mm = component(move.end_mm, axis);
    if (!move.known_end[axis] || move.fixed[axis]) {
      position[axis] = move.known_end[axis] ? std::optional(end_mm) : std::nullopt;
    } else if (move.cycle && axis == 2) {
      position[axis] = round_cycle_end(move, start, move.cycle->retract_mm, {}).position_mm;
    } else if (move.words[axis]) {
      Coordinate kept;
      keep(move, axis, start[axis], kept);
      position[axis] = kept.position_mm;
    }
  }
  if (move.orientation) {
    if (!position.orientation) position.orientation = move.orientation->end;
    for (std::size_t i = 0; i < 4; ++i)
      if (move.orientation->words[i]) (*position.orientation)[i] = move.orientation->end[i];
  }
  forget_skippable(move, start, position);
  return position;
}

void forget_skippable(const Move& move, const TextPosition& before, TextPosition& position) {
  if (!move.block_delete) return;
  position.orientation.reset();
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (move.words[axis] || before[axis] != position[axis]) position[axis].reset();
}

namespace {

/// Whether a word, and only a word, gives the position of the axis.
bool is_given_by_word(const Move& move, std::size_t axis) {
  return move.words[axis] && move.known_end[axis] && !is_relative(move, axis) && !move.fixed[axis] &&
         !(move.cycle && axis == 2);
}

/// The result of `round_axis` for such an axis; nearly all axes are like this.
double position_of_word(const Move& move, std::size_t axis, double wanted_mm, const WriteOptions& options) {
  const double end_mm = component(move.end_mm, axis), wanted = in_unit(wanted_mm, move.unit);
  const int decimals = decimals_of_word(move, decimals_shown(move.words[axis]), Place::end, options);
  if (rounds_to(in_unit(end_mm, move.unit), wanted, decimals)) return end_mm;
  return rounded(wanted, decimals) * mm_per(move.unit);
}

}  // namespace

TextPosition text_position_after(const Move& move, const TextPosition& before, const Vector3& end_mm,
                                 const WriteOptions& options) {
  const TextPosition start = known_text_position(move, before);
  TextPosition position;
  if (move.angle_axis != 0) {
    position = round_step(move, start, {end_mm}, motion_of(move), Place::end, options).after;
    forget_skippable(move, start, position);
    return position;
  }
  position.cycle_initial_mm = cycle_initial_after(move, start);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double wanted_mm = component(end_mm, axis);
    if (is_given_by_word(move, axis))
      position[axis] = position_of_word(move, axis, wanted_mm, options);
    else
      position[axis] = round_axis(move, axis, start, wanted_mm, Place::end, options).position_mm;
  }
  forget_skippable(move, start, position);
  return position;
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
