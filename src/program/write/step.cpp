#include "program/write/step.hpp"

#include <algorithm>
#include <cmath>

#include "counterflex/files/text.hpp"
#include "program/dialect.hpp"
#include "program/text/number_style.hpp"
#include "program/write/text_cycle.hpp"

namespace counterflex {
namespace {

Vector3 point_of(const TextPosition& position) {
  return {position[0].value_or(0), position[1].value_or(0), position[2].value_or(0)};
}

bool plane_is_known(const ArcMove& arc, const TextPosition& position) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (in_plane(arc, axis) && !position[axis]) return false;
  return true;
}

/// Polar words stay if they lead, about the new pole, to the end of the arc. Otherwise the arc ends with
/// words of both axes of its plane, unless its height changes: only polar words allow a height.
void round_polar(const Move& move, const Via& via, const WriteOptions& options, Step& step) {
  constexpr double digits_of_rounding = 0.75, digits_of_start_and_pole = 2;
  if (!step.arc) return;
  const Curve kept = polar_arc(move, step.arc->curve.start, step.arc->curve.arc->centre);
  const double digit_mm = mm_per(move.unit) / power_of_ten(decimals_of(move, options).inserted);
  Vector3 miss = kept.end - via.end_mm;
  miss[move.arc->normal] = 0;
  const bool only_polar = !stays_flat(move) || move.arc->turns > 0;
  const double room = (only_polar ? digits_of_start_and_pole : digits_of_rounding) * digit_mm;
  const bool stays = step.place == Place::end && miss.norm() <= room;
  if (!stays && !stays_flat(move) && step.place == Place::end) return step.arc.reset();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!in_plane(*move.arc, axis)) continue;
    Coordinate& c = step.axes[axis];
    c.number.write = !stays;
    if (!stays) c.number.value = rounded(c.number.value, c.number.decimals);
    c.position_mm = stays ? component(kept.end, axis) : c.number.value * mm_per(move.unit);
    step.after[axis] = c.position_mm;
  }
  const Vector3 end = point_of(step.after);
  if (stays) {
    step.arc->curve.end = end;
    step.arc->curve.arc->sweep = kept.arc->sweep;
  } else {
    step.arc = round_arc(move, step.arc->curve.start, end, via, step.place, options);
  }
}

}  // namespace

int motion_of(const Move& move) {
  if (move.arc) return move.arc->clockwise ? 2 : 3;
  return move.motion == Motion::rapid ? 0 : 1;
}

namespace {

/// The direction of a line stays if neither its start nor the coordinate beside it changes. Otherwise the
/// other coordinate is written.
void round_angle(const Move& move, const Via& via, const WriteOptions& options, Step& step) {
  const std::size_t axis = move.angle_axis - 1U, other = 1 - axis;
  Coordinate& c = step.axes[axis];
  const auto start_has_changed = [&](std::size_t i) { return step.before[i] != component(move.start_mm, i); };
  if (c.number.write || (!step.axes[other].number.write && !start_has_changed(0) && !start_has_changed(1)))
    return;
  Move without = move;
  without.words[axis].reset();
  const Coordinate written = round_axis(without, axis, is_relative(move, axis) ? step.before : TextPosition{},
                                        component(via.end_mm, axis), step.place, options);
  if (written.number.write) c = written;
}

/// Whether the four numbers of a quaternion in the text, which few digits make a little longer or shorter
/// than 1, are those of the unit quaternion `wanted`.
bool is_quaternion_of(const OrientationNumbers& text, const OrientationNumbers& wanted, int decimals) {
  double squares = 0;
  for (const double number : text) squares += number * number;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (!rounds_to(text[i] / std::sqrt(squares), wanted[i], decimals)) return false;
  return true;
}

/// The numbers of a quaternion that keep those of the text where these are the wanted orientation.
OrientationNumbers kept_quaternion(const Move& move, const OrientationNumbers& wanted, const Step& step) {
  const bool at_end = step.place != Place::inside;
  if (!at_end && !step.before.orientation) return wanted;
  const OrientationNumbers& text = at_end ? move.orientation->end : *step.before.orientation;
  return is_quaternion_of(text, wanted, quaternion_decimals) ? text : wanted;
}

void round_orientation(const Move& move, const Via& via, Step& step) {
  OrientationNumbers wanted = via.orientation ? *via.orientation : move.orientation->end;
  if (move.orientation->form == OrientationForm::quaternion) wanted = kept_quaternion(move, wanted, step);
  OrientationNumbers& after = step.after.orientation.emplace();
  if (move.relative) {  // a number in a relative block would be a difference: the orientation stays
    after = step.before.orientation.value_or(move.orientation->end);
    return;
  }
  for (std::size_t i = 0; i < number_count(move.orientation->form); ++i) {
    step.angles[i] = round_angle(move, i, step.before, wanted[i], step.place);
    after[i] = step.angles[i].value;
  }
}

}  // namespace

Step round_step(const Move& move, const TextPosition& before, const Via& via, int motion, Place place,
                const WriteOptions& options) {
  const bool has_height = place == Place::end && move.arc && !stays_flat(move);
  const bool flat = motion >= 2 && move.arc && move.arc->flat && via.centre_mm && !has_height;
  const auto axis_coordinate = [&](std::size_t axis) {
    if (flat && !in_plane(*move.arc, axis)) {
      Coordinate kept;
      assign(kept.position_mm, before[axis]);
      return kept;
    }
    return round_axis(move, axis, before, component(via.end_mm, axis), place, options);
  };
  Step step(place, motion, before, axis_coordinate);
  if (move.angle_axis != 0 && place != Place::inside) round_angle(move, via, options, step);
  for (std::size_t axis = 0; axis < 3; ++axis) assign(step.after[axis], step.axes[axis].position_mm);
  step.after.cycle_initial_mm = cycle_initial_after(move, before);
  if (move.orientation) round_orientation(move, via, step);
  if (motion < 2 || !move.arc) return step;
  if (via.centre_mm) {
    // If the start is unknown, the arc is not changed.
    if (!plane_is_known(*move.arc, before) || !plane_is_known(*move.arc, step.after)) return step;
    step.arc = round_arc(move, point_of(before), point_of(step.after), via, place, options);
    if (move.polar && place != Place::inside) round_polar(move, via, options, step);
    if (step.arc) return step;
    // The rest of the arc is shorter than its digits resolve: the next piece includes it.
    if (place == Place::inside) step.after = before, step.angles = {};
  }
  step.motion = 1;
  return step;
}

bool equals_text_position(const Step& step) {
  const auto writes = [](const WordNumber& number) { return number.write; };
  const auto &start = step.before.orientation, &end = step.after.orientation;
  const bool turns = start && end && *start != *end;
  return !step.arc && step.after == step.before && !turns && std::ranges::none_of(step.angles, writes);
}

bool writes_words(const Step& step) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (step.axes[axis].number.write || (step.arc && step.arc->centre[axis].write)) return true;
  return step.arc && step.arc->radius.write;
}

Curve curve_of_step(const Step& step) {
  return step.arc ? step.arc->curve : Curve{point_of(step.before), point_of(step.after), {}};
}

Curve as_written(const Move& move, const TextPosition& before, const Via& via, bool is_end,
                 const WriteOptions& options) {
  return curve_of_step(
      round_step(move, before, via, motion_of(move), is_end ? Place::end : Place::inside, options));
}

}  // namespace counterflex
