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

}  // namespace counterflex
