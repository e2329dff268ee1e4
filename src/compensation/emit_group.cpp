// Contour groups under G41 or G42: one shift, so that the setter's offsets of the tool still work.
#include <fmt/format.h>

#include <cmath>

#include "counterflex/geometry/units.hpp"
#include "emitter.hpp"

namespace counterflex {

// Per axis of the program the midpoint of the extremes of the corrections along the group; nothing where no
// move of the group has a known start and end. What it leaves is listed.
std::optional<Vector3> Emitter::group_shift_mm(std::size_t m, std::size_t s) {
  const Move& first = job_.program.moves[m];
  Vector3 low = Vector3::Constant(HUGE_VAL), high = -low;
  int last_line = first.line;
  for (; s < job_.path.segments.size(); ++s) {
    const Move& move = job_.program.moves[job_.path.segments[s].move];
    if (move.group != first.group) break;
    last_line = move.line;
    for (const Vector3& c : plan_.segments[s].group) {
      low = low.cwiseMin(shift_mm(move, c));
      high = high.cwiseMax(shift_mm(move, c));
    }
  }
  if (!(low.x() <= high.x())) return std::nullopt;
  const Vector3 shift = (low + high) / 2, residual = (high - low) / 2;
  list(first,
       fmt::format("contour group of lines {} to {}: one shift of ({:.4f}, {:.4f}, {:.4f}) mm for all; what "
                   "remains of its corrections is up to {:.4f} mm",
                   first.line, last_line, shift.x(), shift.y(), shift.z(), residual.norm()));
  return shift;
}

// The group's first move has to make the step: nothing may be inserted after it.
void Emitter::check_step(const Move& move, const Vector3& before_mm) {
  const Vector3 after_mm = shift_mm(move, state_.correction);
  const bool in_plane = move.words[0] || move.words[1];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<Eigen::Index>(axis);
    const double step = after_mm[k] - before_mm[k];
    const bool writes = move.words[axis] || (in_plane && move.may_insert_words);
    if (!move.known_end[axis] || writes || rounds_to_nothing(move, axis, step)) continue;
    return refuse(
        move, fmt::format("the shift of this contour group differs by {:.4f} mm in {} from the correction "
                          "before it, and the block takes no {} word",
                          step, "XYZ"[axis], "XYZ"[axis]));
  }
}

bool Emitter::begin_group(std::size_t m, Index s) {
  const Move& move = job_.program.moves[m];
  state_.group = move.group;
  const std::optional<Vector3> shift = group_shift_mm(m, s.value_or(next_segment_));
  if (!shift) return state_.correction_known;
  const Vector3 before_mm = held_shift_mm(move);
  set_shift(move, *shift);
  state_.holds = {true, true, true};
  check_step(move, before_mm);
  give_to_pending(move);
  return true;
}

void Emitter::emit_group(std::size_t m, Index s) {
  const Move& move = job_.program.moves[m];
  if (move.group != state_.group && !begin_group(m, s)) return pending_.push_back(m);
  if (out_.failure) return;
  emit_rigid(m, s, Kind::shifted);
}

}  // namespace counterflex
