#include "compensation/solve/failures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compensation/solve/solver.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

// The last digit of so many behind the point. It is needed for every move, and much faster than std::pow.
double last_digit(int decimals) {
  double power = 1;
  for (int i = 0; i < std::abs(decimals); ++i) power *= 10;
  return decimals < 0 ? power : 1 / power;
}

double rounding_of(LengthUnit unit, int decimals) {
  return 0.5 * (unit == LengthUnit::inches ? inch : mm) * last_digit(decimals) * std::sqrt(3.0);
}

int fewest_decimals(const Move& move, const WriteOptions& options) {
  const Decimals decimals = decimals_of(move, options);
  return std::min({decimals.end[0], decimals.end[1], decimals.end[2], decimals.inserted});
}

}  // namespace

double rounding_allowance(const Move& move, const WriteOptions& options) {
  return rounding_of(move.unit, fewest_decimals(move, options));
}

double rounding_as_read(const Move& move) {
  const Decimals decimals = decimals_of(move, {});
  int least = std::numeric_limits<int>::max();
  for (std::size_t axis = 0; axis < 3; ++axis)
    least = std::min(least, move.words[axis] ? decimals.end[axis] : decimals.inserted);
  return rounding_of(move.unit, least);
}

Failure few_decimals_failure(const Move& move, const CompensationOptions& options) {
  int enough = 0;
  while (rounding_of(move.unit, enough) > options.tolerance / 2) ++enough;
  return {
      ErrorKind::usage, move.line,
      fmt::format("words are rounded by up to {:.3g} mm here, which leaves too little of the tolerance of "
                  "{:.3g} mm; it needs --decimals {}",
                  rounding_allowance(move, options.write) / mm, options.tolerance / mm, enough)};
}

std::optional<Failure> decimals_failure(const Program& program, const Toolpath& path,
                                        const CompensationOptions& options) {
  std::optional<std::pair<LengthUnit, int>> last;  // digits that have been found to be enough
  for (const Segment& segment : path.segments) {
    const Move& move = program.moves[segment.move];
    const std::pair digits{move.unit, fewest_decimals(move, options.write)};
    if (last == digits) continue;
    if (rounding_allowance(move, options.write) >= options.tolerance)
      return few_decimals_failure(move, options);
    last = digits;
  }
  return std::nullopt;
}

Failure status_failure(const Job& job, Status status, const CommandedPlace& at, int line) {
  if (status == Status::outside_travel) {
    if (const auto word = ambiguous_integer_word(job.program, line))
      return {ErrorKind::program_text, word->line, word->what};
    return {ErrorKind::limit, line, outside_travel_words(job.model.mechanism, at), 0, status};
  }
  return {ErrorKind::not_compensated, line,
          fmt::format("the machine's equilibrium is not solved here: {}", to_string(status)), 0, status};
}

Failure status_failure(const Job& job, Status status, const Segment& segment, const Vector3& target) {
  const Move& move = job.program.moves[segment.move];
  return status_failure(job, status, {model_of(job, segment), job.path.frames[move.frame], move.tool, target},
                        segment.line);
}

std::optional<Failure> limit_failure(const Job& job, const Vector3& correction, int line) {
  const double size = correction.norm();
  if (size <= job.options.max_correction) return std::nullopt;
  if (const auto word = ambiguous_integer_word(job.program, line))
    return Failure{ErrorKind::program_text, word->line, word->what};
  return Failure{ErrorKind::limit, line,
                 fmt::format("the correction would be {:.3f} mm, more than the limit of {:.3f} mm", size / mm,
                             job.options.max_correction / mm)};
}

double position_miss(const Job& job, const Waypoint& w) {
  Vector3 miss = Vector3::Zero();
  for (Component c : job.model.mechanism.controlled)
    if (c <= Component::z) miss[static_cast<int>(c)] = w.after[static_cast<int>(c)];
  return miss.norm();
}

std::optional<Failure> tolerance_failure(const Job& job, const std::vector<Waypoint>& waypoints) {
  for (const Waypoint& w : waypoints) {
    const double miss = position_miss(job, w);
    if (miss <= job.options.tolerance || w.exempt) continue;
    return Failure{
        ErrorKind::not_compensated, w.line,
        fmt::format("verification failed: the tip misses the path by {} mm at {:.1f} % of this move, the "
                    "tolerance is {:.4f} mm",
                    format_beside(miss / mm, job.options.tolerance / mm, 4), 100 * w.fraction,
                    job.options.tolerance / mm),
        w.corrected_line};
  }
  return std::nullopt;
}

std::optional<Failure> branch_failure(const Job& job) {
  PlaceSolver solver(job);
  std::optional<TipPosition> at = job.from;
  for (const Segment& segment : job.path.segments) {
    const Model& model = model_of(job, segment);
    const auto go_to = [&](const Vector3& p) {
      const bool joins = at && at->model == &model;
      if (joins && at->p_MT == p) return Status::converged;
      const Status status = joins ? solver.join(model, at->p_MT, p) : solver.nominal(model, p).status;
      at = TipPosition{&model, p};
      return status;
    };
    std::vector<Vector3> places{segment.wanted.start, segment.wanted.end};
    if (segment.wanted.arc) places = points_along(segment.wanted);
    for (const Vector3& p : places)
      if (const Status status = go_to(p); status != Status::converged)
        return status_failure(job, status, segment, p);
  }
  return std::nullopt;
}

}  // namespace counterflex
