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

void count_moves(const Job& job, const Emission& emission, Compensation& result) {
  OtherMoves& others = result.other_moves;
  for (const EmittedMove& emitted : emission.moves) {
    const Handling handling = job.program.moves[emitted.edit.move].handling;
    if (!emitted.in_part)
      ++result.corrected_moves;
    else if (handling == Handling::group)
      ++others.grouped;
    else if (handling == Handling::own && emitted.kind != EmittedMove::Kind::shifted)
      ++others.in_part;
    else
      ++others.held;
  }
  others.left += job.program.moves.size() - emission.moves.size();
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

std::optional<Failure> decimals_failure(const Program& program, const Toolpath& path,
                                        const CompensationOptions& options) {
  for (const Segment& segment : path.segments) {
    const Move& move = program.moves[segment.move];
    if (rounding_allowance(move, options.write) >= options.tolerance)
      return few_decimals_failure(move, options);
  }
  return std::nullopt;
}

struct Compensator::State {
  Rewriter rewriter;
  TextReader corrected;
  bool attribution;
  EmitterState emitter{};
  std::optional<NominalPlace> nominal{};  ///< where the window before ended; none: home
  std::optional<Vector3> command{};

  std::optional<Failure> plan_and_write(const Job& job, const NominalTrack& track, Emission& emission,
                                        Compensation& result) {
    const Plan planned = plan(job, track);
    if (planned.failure) return planned.failure;
    note_planned_corrections(job, planned, result);
    emission = emit(job, planned, emitter);
    note_first_corrections(job, emission, result);
    result.left_alone = emission.left_alone;
    if (emission.failure) return emission.failure;
    count_moves(job, emission, result);
    result.counts = rewriter.write(job.program, edits_of(emission));
    result.text = std::move(result.counts.text);
    return std::nullopt;
  }

  // What was written is read anew, and solved forward.
  std::optional<Failure> verify(const Job& job, const NominalTrack& track, const Emission& emission,
                                Compensation& result) {
    result.corrected = corrected.read(result.text);
    const std::vector<Piece> pieces = emitted_pieces(job, emission, result.counts, result.corrected);
    ForwardRun run = solve_forward_from(job, track, pieces, {true, attribution, true}, command);
    if (!pieces.empty()) command = pieces.back().commanded.end;
    result.waypoints = std::move(run.waypoints);
    return run.failure ? run.failure : tolerance_failure(job, result.waypoints);
  }

  std::optional<Failure> next(const Job& job, Compensation& result) {
    if (auto failure = decimals_failure(job.program, job.path, job.options)) return failure;
    const NominalTrack path = track(job, nominal.value_or(home_of(job.model)));
    if (path.failure) return path.failure;
    nominal = path.end;
    Emission emission;
    if (auto failure = plan_and_write(job, path, emission, result)) return failure;
    return verify(job, path, emission, result);
  }
};

Compensator::Compensator(const WriteOptions& write, TextReader corrected, bool attribution)
    : state_(new State{Rewriter(write), std::move(corrected), attribution}) {}
Compensator::~Compensator() = default;
Compensator::Compensator(Compensator&&) noexcept = default;

Compensation Compensator::next(const Job& job) {
  Compensation result;
  result.failure = state_->next(job, result);
  return result;
}

Compensation compensate(const Job& job, bool attribution) {
  return Compensator(job.options.write, TextReader(job.program, job.read), attribution).next(job);
}

}  // namespace counterflex
