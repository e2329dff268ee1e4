// Contour groups under G41 or G42: one shift, so that the setter's offsets of the tool still work.
#include <fmt/format.h>

#include <cmath>

#include "counterflex/geometry/units.hpp"
#include "emitter.hpp"

namespace counterflex {

// Whether the contour lies in X Y, as far as its arcs say: Z does not touch the radius of the cutter there,
// and is corrected block by block.
bool Emitter::is_in_xy(std::size_t m) const {
  const auto& moves = job_.program.moves;
  for (const int group = moves[m].group; m < moves.size() && moves[m].group == group; ++m)
    if (moves[m].arc && moves[m].arc->normal != 2) return false;
  return true;
}

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
  const Vector3 shift = (low + high) / 2;
  Vector3 residual = (high - low) / 2;
  if (group_in_xy_) residual.z() = 0;
  const std::string said =
      group_in_xy_
          ? fmt::format("({:.4f}, {:.4f}) mm in X and Y for all, Z block by block", shift.x(), shift.y())
          : fmt::format("({:.4f}, {:.4f}, {:.4f}) mm for all", shift.x(), shift.y(), shift.z());
  list(first, fmt::format("contour group of lines {} to {}: one shift of {}; what remains of its corrections "
                          "is up to {:.4f} mm",
                          first.line, last_line, said, residual.norm()));
  return shift;
}

// The group's first move has to make the step: nothing may be inserted after it.
void Emitter::check_step(const Move& move, const Vector3& before_mm) {
  const Vector3 after_mm = shift_mm(move, state_.correction);
  const bool in_plane = move.words[0] || move.words[1];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<Eigen::Index>(axis);
    const double step = after_mm[k] - before_mm[k];
    const bool flat = move.arc && move.arc->flat && static_cast<int>(axis) == move.arc->normal;
    const bool writes = move.words[axis] || (in_plane && move.may_insert_words && !flat);
    if (!move.known_end[axis] || writes || rounds_to_nothing(move, axis, step)) continue;
    return refuse(
        move, fmt::format("the shift of this contour group differs by {:.4f} mm in {} from the correction "
                          "before it, and the block takes no {} word",
                          step, "XYZ"[axis], "XYZ"[axis]));
  }
}

// The shift of Z at the end of a move of the group, of one that stays or comes from an unknown position where the next
// begins; nothing where Z goes with the group.
std::optional<double> Emitter::height_shift_mm(const Move& move, Index s) const {
  const std::size_t next = s.value_or(next_segment_);
  const bool known = next < plan_.segments.size() && !plan_.segments[next].group.empty() &&
                     job_.program.moves[job_.path.segments[next].move].group == move.group;
  if (!group_in_xy_ || !known) return std::nullopt;
  const std::vector<Vector3>& corrections = plan_.segments[next].group;
  return shift_mm(move, s ? corrections.back() : corrections.front()).z();
}

bool Emitter::begin_group(std::size_t m, Index s) {
  const Move& move = job_.program.moves[m];
  state_.group = move.group;
  group_in_xy_ = is_in_xy(m);
  std::optional<Vector3> shift = group_shift_mm(m, s.value_or(next_segment_));
  if (!shift) return state_.correction_known;
  leave_far_pending_alone(move);
  const Vector3 before_mm = held_shift_mm(move);
  if (const auto height = height_shift_mm(move, s)) shift->z() = *height;
  set_shift(move, *shift);
  state_.holds = {true, true, true};
  check_step(move, before_mm);
  give_to_pending();
  return true;
}

void Emitter::emit_group(std::size_t m, Index s) {
  const Move& move = job_.program.moves[m];
  if (move.group != state_.group && !begin_group(m, s)) return pending_.push_back(m);
  if (out_.failure) return;
  if (const auto height = height_shift_mm(move, s)) {
    Vector3 shift = held_shift_mm(move);
    shift.z() = *height;
    set_shift(move, shift);
  }
  emit_rigid(m, s, Kind::shifted);
}

}  // namespace counterflex
