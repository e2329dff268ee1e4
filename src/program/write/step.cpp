#include "program/write/step.hpp"

#include "counterflex/files/numbers.hpp"
#include "program/dialect.hpp"
#include "program/write/held_cycle.hpp"
#include "program/text/number_style.hpp"

namespace counterflex {
namespace {

Vector3 point_of(const HeldPosition& held) {
  return {held[0].value_or(0), held[1].value_or(0), held[2].value_or(0)};
}

bool plane_is_known(const ArcMove& arc, const HeldPosition& held) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (in_plane(arc, axis) && !held[axis]) return false;
  return true;
}

/// The polar words stay where they lead, about the new pole, to where the arc should end. Else the arc ends
/// in words of both axes of its plane, unless it changes its height, which only polar words hold.
void settle_polar(const Move& move, const Via& via, const WriteOptions& options, Step& step) {
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
    c.held_mm = stays ? component(kept.end, axis) : c.number.value * mm_per(move.unit);
    step.after[axis] = c.held_mm;
  }
  const Vector3 end = point_of(step.after);
  if (stays) {
    step.arc->curve.end = end;
    step.arc->curve.arc->sweep = kept.arc->sweep;
  } else {
    step.arc = settle_arc(move, step.arc->curve.start, end, via, step.place, options);
  }
}

}  // namespace

int motion_of(const Move& move) {
  if (move.arc) return move.arc->clockwise ? 2 : 3;
  return move.motion == Motion::rapid ? 0 : 1;
}

namespace {

/// The direction of a line stays while neither its start nor the coordinate beside it changes; else the coordinate that it
/// says is written.
void settle_angle(const Move& move, const Via& via, const WriteOptions& options, Step& step) {
  const std::size_t axis = move.angle_axis - 1U, other = 1 - axis;
  Coordinate& c = step.axes[axis];
  const auto starts_elsewhere = [&](std::size_t i) { return step.before[i] != component(move.start_mm, i); };
  if (c.number.write || (!step.axes[other].number.write && !starts_elsewhere(0) && !starts_elsewhere(1))) return;
  Move without = move;
  without.words[axis].reset();
  const Coordinate written = settle_axis(without, axis, is_relative(move, axis) ? step.before : HeldPosition{}, component(via.end_mm, axis), step.place, options);
  if (written.number.write) c = written;
}

}  // namespace

Step settle_step(const Move& move, const HeldPosition& before, const Via& via, int motion, Place place,
                 const WriteOptions& options) {
  const bool has_height = place == Place::end && move.arc && !stays_flat(move);
  const bool flat = motion >= 2 && move.arc && move.arc->flat && via.centre_mm && !has_height;
  const auto settled = [&](std::size_t axis) {
    if (flat && !in_plane(*move.arc, axis)) {
      Coordinate kept;
      assign(kept.held_mm, before[axis]);
      return kept;
    }
    return settle_axis(move, axis, before, component(via.end_mm, axis), place, options);
  };
  Step step(place, motion, before, settled);
  if (move.angle_axis != 0 && place != Place::inside) settle_angle(move, via, options, step);
  for (std::size_t axis = 0; axis < 3; ++axis) assign(step.after[axis], step.axes[axis].held_mm);
  step.after.cycle_initial_mm = cycle_initial_after(move, before);
  if (motion < 2 || !move.arc) return step;
  if (via.centre_mm) {
    // About an unknown start nothing is said anew: the arc stays as it stands.
    if (!plane_is_known(*move.arc, before) || !plane_is_known(*move.arc, step.after)) return step;
    step.arc = settle_arc(move, point_of(before), point_of(step.after), via, place, options);
    if (move.polar && place != Place::inside) settle_polar(move, via, options, step);
    if (step.arc) return step;
    // What is left of the arc is less than the digits tell: the next piece makes up for it.
    if (place == Place::inside) step.after = before;
  }
  step.motion = 1;
  return step;
}

bool is_there(const Step& step) {
  return !step.arc && step.after == step.before;
}

bool says_anew(const Step& step) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (step.axes[axis].number.write || (step.arc && step.arc->centre[axis].write)) return true;
  return step.arc && step.arc->radius.write;
}

Curve curve_of_step(const Step& step) {
  return step.arc ? step.arc->curve : Curve{point_of(step.before), point_of(step.after), {}};
}

Curve as_written(const Move& move, const HeldPosition& before, const Via& via, bool is_end,
                 const WriteOptions& options) {
  return curve_of_step(
      settle_step(move, before, via, motion_of(move), is_end ? Place::end : Place::inside, options));
}

}  // namespace counterflex
