#include "plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "counterflex/compensation/compensate.hpp"
#include "counterflex/geometry/units.hpp"
#include "plan_chunk.hpp"

namespace counterflex {
namespace {

// The last digit of so many behind the point. It is asked for at every move.
double last_digit(int decimals) {
  static const auto common = [] {
    std::array<double, 10> digits{};
    for (std::size_t i = 0; i < digits.size(); ++i) digits[i] = std::pow(10.0, -static_cast<int>(i));
    return digits;
  }();
  const auto i = static_cast<std::size_t>(decimals);  // beyond all where it is negative
  return i < common.size() ? common[i] : std::pow(10.0, -decimals);
}

double rounding_of(LengthUnit unit, int decimals) {
  return 0.5 * (unit == LengthUnit::inches ? inch : mm) * last_digit(decimals) * std::sqrt(3.0);
}

}  // namespace

double rounding_allowance(const Move& move, const WriteOptions& options) {
  const Decimals decimals = decimals_of(move, options);
  return rounding_of(move.unit,
                     std::min({decimals.end[0], decimals.end[1], decimals.end[2], decimals.inserted}));
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
      Exit::usage, move.line,
      fmt::format("words are rounded by up to {:.3g} mm here, which leaves too little of the tolerance of "
                  "{:.3g} mm; it needs --decimals {}",
                  rounding_allowance(move, options.write) / mm, options.tolerance / mm, enough)};
}

std::optional<double> room_between_points(const Job& job, const Segment& segment, double gain) {
  const double rounding = rounding_allowance(job.program.moves[segment.move], job.options.write);
  const double room = job.options.tolerance / gain - rounding;
  if (room < least_share * job.options.tolerance) return std::nullopt;
  return room;
}

namespace {

// Segments [begin, end), which need the same model. What fails together is planned one by one: then each
// begins beside the one before it, and the first failure is known.
std::optional<Failure> plan_run(const Job& job, const NominalTrack& track, const Chunk& run, Plan& plan) {
  const Model& model = model_of(job, job.path.segments[run.begin]);
  const auto plan_in = [&](std::size_t together) -> std::optional<Failure> {
    WaypointSolver solver(job, model, track.start_before(run.begin));
    ChunkPlanner planner(job, solver);
    for (std::size_t i = run.begin; i < run.end; i += together)
      if (auto failure = planner.plan(i, i + together, plan)) return failure;
    return std::nullopt;
  };
  const std::size_t count = run.end - run.begin;
  auto failure = plan_in(count);
  return failure && count > 1 ? plan_in(1) : failure;
}

std::optional<Failure> plan_chunk(const Job& job, const NominalTrack& track, const Chunk& chunk, Plan& plan) {
  const auto model = [&](std::size_t i) { return &model_of(job, job.path.segments[i]); };
  for (std::size_t begin = chunk.begin, end = begin; begin < chunk.end; begin = end) {
    while (end < chunk.end && model(end) == model(begin)) ++end;
    if (auto failure = plan_run(job, track, {chunk.index, begin, end}, plan)) return failure;
  }
  return std::nullopt;
}

}  // namespace

Plan plan(const Job& job, const NominalTrack& track) {
  Plan result;
  result.segments.resize(job.path.segments.size());
  std::vector<std::optional<Failure>> failures(chunk_count(result.segments.size()));
  for_each_chunk(result.segments.size(), job.options.threads,
                 [&](const Chunk& chunk) { failures[chunk.index] = plan_chunk(job, track, chunk, result); });
  for (auto& failure : failures)
    if (failure) {
      result.failure = std::move(failure);
      break;
    }
  return result;
}

}  // namespace counterflex
