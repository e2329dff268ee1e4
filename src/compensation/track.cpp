#include "track.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "counterflex/geometry/units.hpp"
#include "path_solver.hpp"

namespace counterflex {
namespace {

// Chunks of pieces begin at any segment: it must not be far from a start.
constexpr std::size_t segments_between_starts = 32;

}  // namespace

Failure status_failure(Status status, int line) {
  if (status == Status::outside_travel)
    return {Exit::limit, line, "an actuator leaves its range (outside_travel)"};
  return {Exit::not_compensated, line,
          fmt::format("the machine's equilibrium is not solved here: {}", to_string(status))};
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

NominalTrack track(const Job& job, const NominalPlace& start) {
  NominalTrack result;
  ToolSolver solvers(job);
  PathSolver* solver = &solvers.of(*start.model, start.configuration);
  const auto go = [&](const Vector3& p, int line) {
    Status status;
    solver->wanted(p, status);
    if (status == Status::converged) return true;
    result.failure = status_failure(status, line);
    return false;
  };
  for (std::size_t i = 0; i < job.path.segments.size(); ++i) {
    const Segment& segment = job.path.segments[i];
    const Model& model = model_of(job, segment);
    const bool changes = !solvers.is_of(model);
    if (changes) solver = &solvers.of(model, model.home);
    const bool joins = i > 0 && !changes && job.path.segments[i - 1].wanted.end == segment.wanted.start;
    if (!joins && !go(segment.wanted.start, segment.line)) return result;
    if (changes || i % segments_between_starts == 0) result.starts.push_back({i, solver->nominal()});
    if (!go(segment.wanted.end, segment.line)) return result;
  }
  result.end = {&solver->model(), solver->nominal()};
  return result;
}

}  // namespace counterflex
