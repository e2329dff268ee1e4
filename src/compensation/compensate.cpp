#include "counterflex/compensation/compensate.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "counterflex/geometry/units.hpp"
#include "emit.hpp"

namespace counterflex {
namespace {

void note_correction(double size, int line, Compensation& result) {
  if (size <= result.largest_correction) return;
  result.largest_correction = size;
  result.largest_correction_line = line;
}

void note_planned_corrections(const Job& job, const Plan& plan, Compensation& result) {
  for (std::size_t s = 0; s < plan.segments.size(); ++s) {
    const Segment& segment = job.path.segments[s];
    const auto note = [&](const Vector3& c) {
      note_correction((c + job.path.frames[segment.frame].datum_shift).norm(), segment.line, result);
    };
    const PlannedSegment& planned = plan.segments[s];
    for (const Knot& knot : planned.knots) note(knot.target - point_at(segment.wanted, knot.u));
    for (const Vector3& c : planned.group) note(c);
    for (const CorrectionCurve& curve : planned.arc)
      for (const CurveInterval& interval : curve.intervals())
        for (const CurveNode& node : interval.nodes) note(node.c);
  }
}

// Positions that come from unknown ones, and holes, have no segment.
void note_first_corrections(const Job& job, const Emission& emission, Compensation& result) {
  for (const EmittedMove& emitted : emission.moves) {
    const Move& move = job.program.moves[emitted.edit.move];
    Vector3 shift = emitted.edit.end_mm - move.end_mm;
    if (emitted.kind == EmittedMove::Kind::hole)
      shift.z() = *emitted.edit.bottom_mm - move.cycle->bottom_mm;
    else if (emitted.kind != EmittedMove::Kind::first_known)
      continue;
    note_correction(shift.norm() * mm, move.line, result);
  }
}

// Words that are written too coarsely for the tolerance cannot meet it.
std::optional<Failure> decimals_failure(const Job& job) {
  for (const Segment& segment : job.path.segments) {
    const double rounding = rounding_allowance(job.program.moves[segment.move], job.options.write);
    if (rounding >= job.options.tolerance) return few_decimals_failure(job, segment);
  }
  return std::nullopt;
}

}  // namespace

std::optional<Failure> tolerance_failure(const Job& job, const std::vector<Waypoint>& waypoints) {
  for (const Waypoint& w : waypoints) {
    Vector3 miss = Vector3::Zero();
    for (Component c : job.model.mechanism.controlled)
      if (c <= Component::z) miss[static_cast<int>(c)] = w.after[static_cast<int>(c)];
    if (miss.norm() <= job.options.tolerance || w.exempt) continue;
    return Failure{
        Exit::not_compensated, w.line,
        fmt::format("verification failed: the tip misses the path by {:.4f} mm at {:.1f} % of this move, the "
                    "tolerance is {:.4f} mm",
                    miss.norm() / mm, 100 * w.fraction, job.options.tolerance / mm)};
  }
  return std::nullopt;
}

Compensation compensate(const Job& job, bool attribution) {
  Compensation result;
  result.failure = decimals_failure(job);
  if (result.failure) return result;
  const NominalTrack nominal = track(job);
  const Plan planned = nominal.failure ? Plan{{}, nominal.failure} : plan(job, nominal);
  if (planned.failure) {
    result.failure = planned.failure;
    return result;
  }
  note_planned_corrections(job, planned, result);
  Emission emission = emit(job, planned);
  note_first_corrections(job, emission, result);
  result.left_alone = emission.left_alone;
  result.failure = emission.failure;
  if (result.failure) return result;
  result.corrected_moves = static_cast<std::size_t>(std::count_if(
      emission.moves.begin(), emission.moves.end(), [](const EmittedMove& move) { return !move.in_part; }));
  result.counts = rewrite(job.program, edits_of(emission), job.options.write);
  result.text = std::move(result.counts.text);
  result.corrected = read_program(result.text, job.program.file, job.read);
  const std::vector<Piece> pieces = emitted_pieces(job, emission, result.counts, result.corrected);
  ForwardRun verified = solve_forward_along(job, pieces, {true, attribution, true});
  result.waypoints = std::move(verified.waypoints);
  result.failure = verified.failure ? verified.failure : tolerance_failure(job, result.waypoints);
  return result;
}

}  // namespace counterflex
