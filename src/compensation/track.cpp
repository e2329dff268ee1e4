#include "track.hpp"

#include <fmt/format.h>

#include "counterflex/geometry/units.hpp"
#include "path_solver.hpp"

namespace counterflex {

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

NominalTrack track(const Job& job, const Configuration& start) {
  NominalTrack result;
  PathSolver solver(job, start);
  const auto go = [&](const Vector3& p, int line) {
    Status status;
    solver.wanted(p, status);
    if (status == Status::converged) return true;
    result.failure = status_failure(status, line);
    return false;
  };
  for (std::size_t i = 0; i < job.path.segments.size(); ++i) {
    const Segment& segment = job.path.segments[i];
    const bool joins = i > 0 && job.path.segments[i - 1].wanted.end == segment.wanted.start;
    if (!joins && !go(segment.wanted.start, segment.line)) return result;
    if (i % chunk_size == 0) result.starts.push_back(solver.nominal());
    if (!go(segment.wanted.end, segment.line)) return result;
  }
  result.end = solver.nominal();
  return result;
}

}  // namespace counterflex
