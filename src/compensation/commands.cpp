#include "commands.hpp"

#include "counterflex/geometry/units.hpp"

namespace counterflex {

Vector3 in_words_mm(const Job& job, const Move& move, const Vector3& target) {
  return inverse(job.path.frames[move.frame].X_MW) * target / mm;
}

Vector3 position_of_words(const Job& job, const Move& move, const Vector3& words_mm) {
  return job.path.frames[move.frame].X_MW * (words_mm * mm);
}

Vector3 original_command(const Job& job, std::size_t frame, const Vector3& p_MT) {
  return p_MT - job.path.frames[frame].datum_shift;
}

Vector3 target_of(const Job& job, const Move& move) {
  return position_of_words(job, move, move.end_mm);
}

Curve command_of(const Job& job, const Move& move) {
  if (!move.arc)
    return {position_of_words(job, move, move.start_mm), position_of_words(job, move, move.end_mm), {}};
  Curve curve = curve_of(move);
  curve.start *= mm;
  curve.end *= mm;
  curve.arc->centre *= mm;
  return job.path.frames[move.frame].X_MW * curve;
}

Vector3 wanted_of(const Job& job, const Move& move) {
  return wanted_frame(job.path.frames[move.frame]) * (move.end_mm * mm);
}

Vector3 bottom_of(const Move& move) {
  return {move.end_mm.x(), move.end_mm.y(), move.cycle->bottom_mm};
}

}  // namespace counterflex
