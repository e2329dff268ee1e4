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
               ForwardRun& out) {
  const Model& model = model_of(job, pieces.front());
  const std::size_t segment = pieces.front().segment, solved = out.waypoints.size();
  const auto solve_in = [&](std::size_t together) {
    WaypointSolver solver(job, model, segment == no_segment ? model.home : nominal.start_before(segment));
    ChunkForward chunk(job, questions, solver);
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

// A chunk of pieces by itself.
ForwardRun solve_chunk(const Job& job, const NominalTrack& nominal, std::span<const Piece> pieces, const Chunk& chunk,
                       const Questions& questions, const std::optional<Vector3>& command) {
  ForwardRun run;
  for (std::size_t i = chunk.begin, end = i; i < chunk.end && !run.failure; i = end) {
    while (end < chunk.end && &model_of(job, pieces[end]) == &model_of(job, pieces[i])) ++end;
    const std::optional<Vector3> last = i == 0 ? command : pieces[i - 1].commanded.end;
    solve_run(job, nominal, pieces.subspan(i, end - i), questions, last, run);
  }
  return run;
}

// Where chunks of pieces begin, and their end: each has `chunk_size` pieces, or fewer with about 2048 places.
std::vector<std::size_t> chunk_borders(const Job& job, std::span<const Piece> pieces, const Questions& questions) {
  constexpr double most_places = 8 * chunk_size;
  std::vector<std::size_t> borders{0};
  double places = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (i - borders.back() == chunk_size || places >= most_places) {
      borders.push_back(i);
      places = 0;
    }
    const Piece& piece = pieces[i];
    const bool inside = questions.inside && !piece.end_only && piece.segment != no_segment;
    places += 1 + (inside ? (piece.u1 - piece.u0) * steps_along(job.path.segments[piece.segment]) : 0.0);
  }
  borders.push_back(pieces.size());
  return borders;
}

}  // namespace

std::optional<Failure> solve_forward_in_portions(const Job& job, const NominalTrack& nominal,
                                                 std::span<const Piece> pieces, const Questions& questions,
                                                 const std::optional<Vector3>& command, std::size_t together,
                                                 const WaypointTaker& take) {
  const std::vector<std::size_t> borders = chunk_borders(job, pieces, questions);
  const std::size_t count = borders.size() - 1;
  for (std::size_t first = 0; first < count; first += together) {
    std::vector<ForwardRun> runs(std::min(together, count - first));
    for_each_index(runs.size(), job.options.threads, [&](std::size_t i) {
      const Chunk chunk{first + i, borders[first + i], borders[first + i + 1]};
      runs[i] = solve_chunk(job, nominal, pieces, chunk, questions, command);
    });
    for (ForwardRun& run : runs) {
      take(std::move(run.waypoints));
      if (run.failure) return run.failure;
    }
  }
  return std::nullopt;
}

ForwardRun solve_forward_from(const Job& job, const NominalTrack& nominal, std::span<const Piece> pieces,
                              const Questions& questions, const std::optional<Vector3>& command) {
  ForwardRun all;
  all.waypoints.reserve(pieces.size() + pieces.size() / 2);
  const std::size_t together = job.options.threads == 1 ? 1 : all_chunks;
  all.failure = solve_forward_in_portions(
      job, nominal, pieces, questions, command, together, [&](std::vector<Waypoint>&& some) {
        all.waypoints.insert(all.waypoints.end(), std::make_move_iterator(some.begin()),
                             std::make_move_iterator(some.end()));
      });
  return all;
}

ForwardRun solve_forward_along(const Job& job, const std::vector<Piece>& pieces, const Questions& questions) {
  const NominalTrack nominal = track(job, home_of(job.model));
  if (nominal.failure) return {{}, nominal.failure};
  return solve_forward_from(job, nominal, pieces, questions, {});
}

namespace {

bool is_known_hole(const Move& move) {
  const auto& fixed = move.fixed;
  return move.cycle && move.handling == Handling::own && !fixed[0] && !fixed[1] && !fixed[2];
}

// The bottom of a hole of the original program.
Piece piece_of_hole(const Job& job, const Move& move) {
  const WorkFrame& frame = job.path.frames[move.frame];
  const Vector3 commanded = frame.X_MW * (bottom_of(move) * mm);
  return {.segment = no_segment,
          .line = move.line,
          .frame = move.frame,
          .commanded = {commanded, commanded, {}},
          .wanted = wanted_frame(frame) * (bottom_of(move) * mm),
          .end_only = true,
          .tool = move.tool};
}

bool is_first_known(const Move& move) {
  return all_known(move.known_end) && !all_known(move.known_start) && !move.cycle;
}

// The end of a move from a position that is not known, of the original program.
Piece piece_of_position(const Job& job, const Move& move) {
  const Vector3 commanded = target_of(job, move);
  return {.segment = no_segment,
          .line = move.line,
          .frame = move.frame,
          .commanded = {commanded, commanded, {}},
          .wanted = wanted_of(job, move),
          .end_only = true,
          .tool = move.tool};
}

// Of segments [begin, end) and the holes and first positions before them; behind the last segment all that are left.
std::vector<Piece> original_pieces(const Job& job, std::size_t begin, std::size_t end) {
  const std::vector<Segment>& segments = job.path.segments;
  std::vector<Piece> pieces;
  std::vector<double> places;
  ForceCursor cursor;
  std::size_t next_move = begin == 0 ? 0 : segments[begin - 1].move;
  const auto add_ends_before = [&](std::size_t end_move) {
    for (; next_move < end_move; ++next_move) {
      const Move& move = job.program.moves[next_move];
      if (is_known_hole(move)) pieces.push_back(piece_of_hole(job, move));
      if (is_first_known(move)) pieces.push_back(piece_of_position(job, move));
    }
  };
  for (std::size_t s = begin; s < end; ++s) {
    const Segment& segment = segments[s];
    add_ends_before(segment.move);
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
  if (end == segments.size()) add_ends_before(job.program.moves.size());
  return pieces;
}

}  // namespace

std::vector<Piece> original_pieces(const Job& job) {
  return original_pieces(job, 0, job.path.segments.size());
}

std::optional<Failure> solve_original(const Job& job, const Questions& questions, ForwardState& state,
                                      const WaypointTaker& take) {
  constexpr std::size_t at_once = 16 * chunk_size;  // segments: their pieces take some megabytes
  const NominalTrack nominal = track(job, state.nominal.value_or(home_of(job.model)));
  if (nominal.failure) return nominal.failure;
  const std::size_t count = job.path.segments.size();
  std::size_t begin = 0;
  do {
    const std::size_t end = std::min(begin + at_once, count);
    const std::vector<Piece> pieces = original_pieces(job, begin, end);
    if (auto failure = solve_forward_in_portions(job, nominal, pieces, questions, state.command, few_chunks, take))
      return failure;
    if (!pieces.empty()) state.command = pieces.back().commanded.end;
    begin = end;
  } while (begin < count);
  state.nominal = nominal.end;
  return std::nullopt;
}

}  // namespace counterflex
