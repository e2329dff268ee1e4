#include "run/failed_line.hpp"

namespace counterflex::cli {
namespace {

/// The pieces of one line, and where the piece before them ends.
struct LinePieces {
  std::vector<Piece> pieces;
  std::optional<Vector3> command;
};

LinePieces pieces_of_line(const Job& job, int line) {
  LinePieces of_line;
  for (const Piece& piece : original_pieces(job)) {
    if (piece.line == line)
      of_line.pieces.push_back(piece);
    else if (of_line.pieces.empty())
      of_line.command = point_at(piece.commanded, 1);
  }
  return of_line;
}

std::optional<SourcesAtWorst> largest_in(const std::vector<Waypoint>& waypoints) {
  const Waypoint* largest = nullptr;
  const auto size = [](const Waypoint& w) { return w.before.head<3>().norm(); };
  for (const Waypoint& w : waypoints)
    if (w.status == Status::converged && knows_before(w) && (largest == nullptr || size(w) > size(*largest)))
      largest = &w;
  if (largest == nullptr || !largest->causes) return std::nullopt;
  return sources_at(*largest, *largest->causes);
}

}  // namespace

std::optional<SourcesAtWorst> solve_failed_line(Run& run, int line) {
  if (line <= 0) return std::nullopt;
  ProgramReader reader(run.file.bytes, run.program.file, run.read, window_moves);
  JobWindows windows(run.input(), reader);
  for (JobWindow window; windows.next(window);) {
    const Job job = windows.job(window);
    const LinePieces of_line = pieces_of_line(job, line);
    if (of_line.pieces.empty()) continue;
    const Questions questions{.before = true, .attribution = true, .inside = false};
    return largest_in(solve_pieces(job, of_line.pieces, questions, of_line.command).waypoints);
  }
  return std::nullopt;
}

}  // namespace counterflex::cli
