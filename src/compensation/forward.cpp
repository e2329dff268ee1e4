#include <algorithm>
#include <iterator>

#include "counterflex/compensation/waypoint.hpp"
#include "counterflex/geometry/units.hpp"
#include "emit.hpp"
#include "forward_chunk.hpp"
#include "sample_places.hpp"
#include "track.hpp"

namespace counterflex {
namespace {

const Model& model_of(const Job& job, const Piece& piece) {
  if (job.tools == nullptr || job.tools->empty()) return job.model;
  return piece.segment == no_segment ? model_with(job.model, job.tools, piece.tool)
                                     : model_of(job, job.path.segments[piece.segment]);
}

// Pieces of one model. What fails together is solved one by one: then each begins beside the one before it,
// and the first failure is known.
void solve_run(const Job& job, const NominalTrack& nominal, std::span<const Piece> pieces,
               const Questions& questions, const std::optional<Vector3>& command,
               std::span<const KnownSegment> known, ForwardRun& out) {
  const Model& model = model_of(job, pieces.front());
  const std::size_t segment = pieces.front().segment, solved = out.waypoints.size();
  const auto solve_in = [&](std::size_t together) {
    WaypointSolver solver(job, model, segment == no_segment ? model.home : nominal.start_before(segment));
    ChunkForward chunk(job, questions, known, solver);
    std::optional<Vector3> last = command;
    out.failure.reset();
    out.waypoints.resize(solved);
    for (std::size_t i = 0; i < pieces.size() && !out.failure; i += together) {
      const auto some = pieces.subspan(i, together);
      out.failure = chunk.solve(some, last, out.waypoints);
      last = some.back().commanded.end;
    }
  };
  solve_in(pieces.size());
  if (out.failure && pieces.size() > 1) solve_in(1);
}

}  // namespace

ForwardRun solve_forward_from(const Job& job, const NominalTrack& nominal, std::span<const Piece> pieces,
                              const Questions& questions, const std::optional<Vector3>& command,
                              std::span<const KnownSegment> known) {
  const auto solve = [&](const Chunk& chunk, ForwardRun& run) {
    for (std::size_t i = chunk.begin, end = i; i < chunk.end && !run.failure; i = end) {
      while (end < chunk.end && &model_of(job, pieces[end]) == &model_of(job, pieces[i])) ++end;
      const std::optional<Vector3> last = i == 0 ? command : pieces[i - 1].commanded.end;
      solve_run(job, nominal, pieces.subspan(i, end - i), questions, last, known, run);
    }
  };
  ForwardRun all;
  if (job.options.threads == 1) {
    all.waypoints.reserve(pieces.size() + pieces.size() / 2);
    for_each_chunk(pieces.size(), 1, [&](const Chunk& chunk) { solve(chunk, all); });
    return all;
  }
  std::vector<ForwardRun> runs(chunk_count(pieces.size()));
  for_each_chunk(pieces.size(), job.options.threads,
                 [&](const Chunk& chunk) { solve(chunk, runs[chunk.index]); });
  std::size_t count = 0;
  for (const ForwardRun& run : runs) count += run.waypoints.size();
  all.waypoints.reserve(count);
  for (ForwardRun& run : runs) {
    all.waypoints.insert(all.waypoints.end(), std::make_move_iterator(run.waypoints.begin()),
                         std::make_move_iterator(run.waypoints.end()));
    if (!run.failure) continue;
    all.failure = run.failure;
    break;
  }
  return all;
}

ForwardRun solve_forward_along(const Job& job, const std::vector<Piece>& pieces, const Questions& questions,
                               ForwardState& state) {
  const NominalTrack nominal = track(job, state.nominal.value_or(home_of(job.model)));
  if (nominal.failure) return {{}, nominal.failure};
  ForwardRun run = solve_forward_from(job, nominal, pieces, questions, state.command);
  state.nominal = nominal.end;
  if (!pieces.empty()) state.command = pieces.back().commanded.end;
  return run;
}

ForwardRun solve_forward_along(const Job& job, const std::vector<Piece>& pieces, const Questions& questions) {
  ForwardState state;
  return solve_forward_along(job, pieces, questions, state);
}

namespace {

bool is_known_hole(const Move& move) {
  const auto& fixed = move.fixed;
  return move.cycle && move.handling == Handling::own && !fixed[0] && !fixed[1] && !fixed[2];
}

// The bottom of a hole of the original program.
Piece piece_of_hole(const Job& job, const Move& move) {
  const WorkFrame& frame = job.path.frames[move.offset];
  const Vector3 commanded = frame.X_MW * (bottom_of(move) * mm);
  return {.segment = no_segment,
          .line = move.line,
          .frame = move.offset,
          .commanded = {commanded, commanded, {}},
          .wanted = wanted_frame(frame) * (bottom_of(move) * mm),
          .end_only = true,
          .tool = move.tool};
}

}  // namespace

std::vector<Piece> original_pieces(const Job& job) {
  std::vector<Piece> pieces;
  std::vector<double> places;
  ForceCursor cursor;
  std::size_t next_move = 0;
  const auto add_holes_before = [&](std::size_t end) {
    for (; next_move < end; ++next_move)
      if (is_known_hole(job.program.moves[next_move]))
        pieces.push_back(piece_of_hole(job, job.program.moves[next_move]));
  };
  for (std::size_t s = 0; s < job.path.segments.size(); ++s) {
    const Segment& segment = job.path.segments[s];
    add_holes_before(segment.move);
    const Pose back{Matrix3::Identity(), -job.path.frames[segment.frame].datum_shift};
    places_along(job, s, cursor, places);
    double u0 = 0;
    for (const double u : places) {
      pieces.push_back({.segment = s,
                        .line = segment.line,
                        .u0 = u0,
                        .u1 = u,
                        .frame = segment.frame,
                        .commanded = back * stretch(segment.wanted, u0, u),
                        .end_only = !segment.cutting});
      u0 = u;
    }
  }
  add_holes_before(job.program.moves.size());
  return pieces;
}

}  // namespace counterflex
