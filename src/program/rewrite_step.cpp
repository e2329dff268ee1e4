#include "program/rewrite_step.hpp"

#include "program/held_cycle.hpp"

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

}  // namespace

int motion_of(const Move& move) {
  if (move.arc) return move.arc->clockwise ? 2 : 3;
  return move.motion == Motion::rapid ? 0 : 1;
}

Step settle_step(const Move& move, const HeldPosition& before, const Via& via, int motion, Place place,
                 const WriteOptions& options) {
  const auto settled = [&](std::size_t axis) {
    return settle_axis(move, axis, before, component(via.end_mm, axis), place, options);
  };
  Step step(place, motion, before, settled);
  for (std::size_t axis = 0; axis < 3; ++axis) assign(step.after[axis], step.axes[axis].held_mm);
  step.after.cycle_initial_mm = cycle_initial_after(move, before);
  if (motion < 2 || !move.arc) return step;
  if (via.centre_mm) {
    // About an unknown start nothing is said anew: the arc stays as it stands.
    if (!plane_is_known(*move.arc, before) || !plane_is_known(*move.arc, step.after)) return step;
    step.arc = settle_arc(move, point_of(before), point_of(step.after), via, place, options);
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
