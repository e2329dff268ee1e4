#include "counterflex/compensation/compensate.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "counterflex/geometry/units.hpp"
#include "emit.hpp"

namespace counterflex {
namespace {

void note_largest_correction(const Job& job, const Plan& plan, Compensation& result) {
  for (std::size_t s = 0; s < plan.segments.size(); ++s)
    for (const Knot& knot : plan.segments[s].knots) {
      const Segment& segment = job.path.segments[s];
      const Vector3 wanted = segment.p_MT_start + knot.u * (segment.p_MT_end - segment.p_MT_start);
      const double size = (knot.target - wanted + job.datum_shift).norm();
      if (size <= result.largest_correction) continue;
      result.largest_correction = size;
      result.largest_correction_line = segment.line;
    }
}

}  // namespace

std::optional<Failure> tolerance_failure(const Job& job, const std::vector<Waypoint>& waypoints) {
  for (const Waypoint& w : waypoints) {
    Vector3 miss = Vector3::Zero();
    for (Component c : job.model.mechanism.controlled)
      if (c <= Component::z) miss[static_cast<int>(c)] = w.after[static_cast<int>(c)];
    if (miss.norm() <= job.options.tolerance || (w.exempt && w.between)) continue;
    return Failure{Exit::not_compensated, w.line,
                   fmt::format("verification failed: the tip misses the path by {:.4f} mm at {:.1f} % of this move, the "
                               "tolerance is {:.4f} mm",
                               miss.norm() / mm, 100 * w.fraction, job.options.tolerance / mm)};
  }
  return std::nullopt;
}

Compensation compensate(const Job& job, bool attribution) {
  Compensation result;
  const NominalTrack nominal = track(job);
  const Plan planned = nominal.failure ? Plan{{}, nominal.failure} : plan(job, nominal);
  if (planned.failure) {
    result.failure = planned.failure;
    return result;
  }
  note_largest_correction(job, planned, result);
  Emission emission = emit(job, planned);
  result.left_alone = emission.left_alone;
  result.failure = emission.failure;
  if (result.failure) return result;
  result.corrected_moves = emission.edits.size();
  result.counts = rewrite(job.program, emission.edits, job.options.write);
  result.text = std::move(result.counts.text);
  const Program corrected = read_program(result.text, job.program.file, job.read);
  const std::vector<Piece> pieces = emitted_pieces(job, planned, emission, result.counts, corrected);
  ForwardRun verified = solve_forward_along(job, pieces, {true, attribution, true});
  result.waypoints = std::move(verified.waypoints);
  result.failure = verified.failure ? verified.failure : tolerance_failure(job, result.waypoints);
  return result;
}

}  // namespace counterflex
