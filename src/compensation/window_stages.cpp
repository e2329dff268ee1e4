#include "window_stages.hpp"

#include "counterflex/geometry/units.hpp"

namespace counterflex {
namespace {

constexpr double indistinct = 1e-10;  // m: of corrections that differ by rounding the first is named

void note_correction(double size, int line, Compensation& result) {
  if (result.largest_correction_line != 0 && size <= result.largest_correction + indistinct) return;
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
    if (planned.end) note(*planned.end - segment.wanted.end);
    for (const Knot& knot : planned.knots) note(knot.target - point_at(segment.wanted, knot.u));
    for (const CurveNode& node : planned.group) note(node.c);
    for (const CorrectionCurve& curve : planned.arc)
      for (const CurveInterval& interval : curve.intervals())
        for (const CurveNode& node : interval.nodes) note(node.c);
  }
}

// Positions that come from unknown ones, and holes, have no segment.
void note_first_corrections(const Job& job, const Emission& emission, Compensation& result) {
  for (const EmittedMove& emitted : emission.moves) {
    const bool hole = emitted.kind == EmittedMove::Kind::hole;
    if (!hole && emitted.kind != EmittedMove::Kind::first_known) continue;
    const Move& move = job.program.moves[emitted.edit.move];
    Vector3 shift = emitted.edit.end_mm - move.end_mm;
    if (hole) shift.z() = *emitted.edit.bottom_mm - move.cycle->bottom_mm;
    note_correction(shift.norm() * mm, move.line, result);
  }
}

void count_moves(const Job& job, const Emission& emission, Compensation& result) {
  OtherMoves& others = result.other_moves;
  for (const EmittedMove& emitted : emission.moves) {
    if (!emitted.in_part) {
      ++result.corrected_moves;
      continue;
    }
    const Handling handling = job.program.moves[emitted.edit.move].handling;
    if (handling == Handling::group)
      ++others.grouped;
    else if (handling == Handling::own && emitted.kind != EmittedMove::Kind::shifted)
      ++others.in_part;
    else
      ++others.held;
  }
  others.left += job.program.moves.size() - emission.moves.size();
}

// Where the last move ends; nothing where it comes from an unknown position.
std::optional<Vector3> last_command(const Job& job, const Program& corrected) {
  if (corrected.moves.empty()) return std::nullopt;
  const Move& last = corrected.moves.back();
  if (last.cycle || !all_known(last.known_start) || !all_known(last.known_end)) return std::nullopt;
  return target_of(job, last);
}

void read_back(const Job& job, CarriedState& carried, Compensation& result) {
  carried.corrected.read(result.text);
  carried.corrected.take_window(result.corrected);
  if (!job.program.moves.empty()) ignore_axes(result.corrected, job.program.moves.front().ignored);
}

}  // namespace

void begin_window(const Job& job, CarriedState& carried, WindowWork& work) {
  work.result.failure = decimals_failure(job.program, job.path, job.options);
  if (work.failed()) return;
  work.track = track(job, carried.nominal.value_or(home_of(job.model)));
  work.result.failure = work.track.failure;
  carried.nominal = work.track.end;
}

void plan_window(const Job& job, WindowWork& work) {
  if (work.failed()) return;
  work.plan = plan(job, work.track);
  work.result.failure = work.plan.failure;
  if (!work.failed()) note_planned_corrections(job, work.plan, work.result);
}

void write_window(const Job& job, CarriedState& carried, WindowWork& work) {
  if (work.failed()) return;
  Compensation& result = work.result;
  Emission emission = emit(job, work.plan, carried.emitter);
  work.ways = planned_ways(job, work.plan);
  work.plan = {};
  note_first_corrections(job, emission, result);
  result.left_alone = std::move(emission.left_alone);
  result.failure = emission.failure;
  if (work.failed()) return;
  count_moves(job, emission, result);
  const std::vector<MoveEdit> edits = take_edits(emission);
  result.counts = carried.rewriter.write(job.program, edits);
  result.text = std::move(result.counts.text);
  read_back(job, carried, result);
  work.command = carried.command;
  carried.command = last_command(job, result.corrected);
}

Matching match_written(const Job& job, const WindowWork& work) {
  if (work.failed()) return {};
  CorrectedMoves found(work.result.corrected);
  OtherLines lines;
  Matching matching = match_window(job, work.track, work.ways, lines, found);
  if (!matching.failure) matching.failure = match_end(lines, found);
  return matching;
}

void solve_matched(const Job& job, bool attribution, const Matching& matching, WindowWork& work) {
  if (!work.failed()) work.result.failure = matching.failure;
  if (work.failed()) return;
  ForwardRun run =
      solve_forward_from(job, work.track, matching.pieces, {true, attribution, true}, work.command);
  work.result.waypoints = std::move(run.waypoints);
  work.result.failure = run.failure;
}

void solve_matched(const Job& job, bool attribution, const Matching& matching, WindowWork& work,
                   const WaypointTaker& take) {
  if (!work.failed()) work.result.failure = matching.failure;
  if (work.failed()) return;
  work.result.failure = solve_forward_in_portions(job, work.track, matching.pieces, {true, attribution, true},
                                                  work.command, few_chunks, take);
}

void verify_window(const Job& job, bool attribution, WindowWork& work) {
  solve_matched(job, attribution, match_written(job, work), work);
  if (!work.failed()) work.result.failure = tolerance_failure(job, work.result.waypoints);
}

}  // namespace counterflex
