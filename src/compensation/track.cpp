#include "track.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "counterflex/geometry/units.hpp"
#include "counterflex/program/read_program.hpp"
#include "path_solver.hpp"

namespace counterflex {
namespace {

// Chunks of pieces begin at any segment: it must not be far from a start.
constexpr std::size_t segments_between_starts = 32;

}  // namespace

Failure status_failure(const Job& job, Status status, const CommandedPlace& at, int line) {
  if (status == Status::outside_travel) {
    if (const auto word = integer_word_in_doubt(job.program, line))
      return {Exit::program_text, word->line, word->what};
    return {Exit::limit, line, outside_travel_words(job.model.mechanism, at), 0, status};
  }
  return {Exit::not_compensated, line,
          fmt::format("the machine's equilibrium is not solved here: {}", to_string(status)), 0, status};
}

Failure status_failure(const Job& job, Status status, const Model& model, const Move& move,
                       const Vector3& target, int line) {
  return status_failure(job, status, {model, job.path.frames[move.frame], move.tool, target}, line);
}

std::optional<Failure> limit_failure(const Job& job, const Vector3& correction, int line) {
  const double size = correction.norm();
  if (size <= job.options.max_correction) return std::nullopt;
  return Failure{Exit::limit, line,
                 fmt::format("the correction would be {:.3f} mm, more than the limit of {:.3f} mm", size / mm,
                             job.options.max_correction / mm)};
}

const Configuration& NominalTrack::start_before(std::size_t segment) const {
  const auto after =
      std::upper_bound(starts.begin(), starts.end(), segment,
                       [](std::size_t s, const TrackStart& start) { return s < start.segment; });
  return std::prev(after)->configuration;
}

namespace {

// Where cells hold the whole path nothing has to be followed; nothing where they do not.
std::optional<NominalTrack> track_by_cells(const Job& job, const NominalPlace& start) {
  if (job.starts == nullptr || job.path.segments.empty()) return std::nullopt;
  NominalTrack result;
  std::optional<BatchSolver> solver;
  const Model* model = start.model;
  std::optional<Vector3> at;
  const auto go = [&](const Vector3& p) {
    const bool known = at ? solver->joins(*at, p) : solver->nominal_near(p) != nullptr;
    at = p;
    return known;
  };
  for (std::size_t i = 0; i < job.path.segments.size(); ++i) {
    const Segment& segment = job.path.segments[i];
    const bool changes = &model_of(job, segment) != model;
    model = &model_of(job, segment);
    if (changes) at.reset();
    if (changes || !solver) solver.emplace(job.starts->of(*model, job.forces.at_platform()));
    if (at != segment.wanted.start && !go(segment.wanted.start)) return std::nullopt;
    if (changes || i % chunk_size == 0) result.starts.push_back({i, *solver->nominal_near(segment.wanted.start)});
    if (segment.wanted.arc && !std::ranges::all_of(points_along(segment.wanted), go)) return std::nullopt;
    if (!go(segment.wanted.end)) return std::nullopt;
  }
  result.end = {model, *solver->nominal_near(*at)};
  return result;
}

}  // namespace

NominalTrack track(const Job& job, const NominalPlace& start) {
  if (auto known = track_by_cells(job, start)) return std::move(*known);
  NominalTrack result;
  ToolSolver solvers(job);
  PathSolver* solver = &solvers.of(*start.model, start.configuration);
  const auto go = [&](const Vector3& p, const Segment& segment) {
    Status status;
    solver->wanted(p, status);
    if (status == Status::converged) return true;
    result.failure =
        status_failure(job, status, solver->model(), job.program.moves[segment.move], p, segment.line);
    return false;
  };
  for (std::size_t i = 0; i < job.path.segments.size(); ++i) {
    const Segment& segment = job.path.segments[i];
    const Model& model = model_of(job, segment);
    const bool changes = !solvers.is_of(model);
    if (changes) solver = &solvers.of(model, model.home);
    const bool joins = i > 0 && !changes && job.path.segments[i - 1].wanted.end == segment.wanted.start;
    if (!joins && !go(segment.wanted.start, segment)) return result;
    if (changes || i % segments_between_starts == 0) result.starts.push_back({i, solver->nominal()});
    if (!go(segment.wanted.end, segment)) return result;
  }
  result.end = {&solver->model(), solver->nominal()};
  return result;
}

}  // namespace counterflex
