#include "foresight.hpp"

#include <limits>

#include "commands.hpp"
#include "counterflex/geometry/curve.hpp"

namespace counterflex {

// Nothing where a move between them may have come elsewhere.
HeldPosition Foresight::before(std::size_t segment) const {
  if (last_ == no_segment || last_ + 1 != segment) return {};
  const std::size_t from = job_->path.segments[last_].move, to = job_->path.segments[segment].move;
  if (from + 1 != to) return {};
  return held_between(job_->program.moves[from], job_->program.moves[to], held_);
}

Vector3 Foresight::command(std::size_t segment, const HeldPosition& held) const {
  Vector3 words_mm;
  for (std::size_t axis = 0; axis < 3; ++axis)
    words_mm[static_cast<Eigen::Index>(axis)] = held[axis].value_or(std::numeric_limits<double>::quiet_NaN());
  return position_of_words(*job_, job_->program.moves[job_->path.segments[segment].move], words_mm);
}

Vector3 Foresight::foresee_end(std::size_t segment, const Vector3& target) {
  const Move& move = job_->program.moves[job_->path.segments[segment].move];
  before_ = before(segment);
  held_ = held_after(move, before_, in_words_mm(*job_, move, target), job_->options.write);
  last_ = segment;
  return command(segment, held_);
}

Vector3 Foresight::inside(std::size_t segment, double u) const {
  if (last_ != segment) return Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  return point_at(Curve{command(segment, before_), command(segment, held_), {}}, u);
}

}  // namespace counterflex
