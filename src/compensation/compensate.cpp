#include "counterflex/compensation/compensate.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "counterflex/files/numbers.hpp"
#include "counterflex/geometry/units.hpp"
#include "window_stages.hpp"

namespace counterflex {

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
        Exit::not_compensated, w.line,
        fmt::format("verification failed: the tip misses the path by {} mm at {:.1f} % of this move, the "
                    "tolerance is {:.4f} mm",
                    format_beside(miss / mm, job.options.tolerance / mm, 4), 100 * w.fraction,
                    job.options.tolerance / mm),
        w.corrected_line};
  }
  return std::nullopt;
}

std::optional<Failure> decimals_failure(const Program& program, const Toolpath& path,
                                        const CompensationOptions& options) {
  std::optional<std::pair<LengthUnit, int>> last;  // digits that have been found to be enough
  for (const Segment& segment : path.segments) {
    const Move& move = program.moves[segment.move];
    const Decimals decimals = decimals_of(move, options.write);
    const std::pair digits{move.unit,
                           std::min({decimals.end[0], decimals.end[1], decimals.end[2], decimals.inserted})};
    if (last == digits) continue;
    if (rounding_allowance(move, options.write) >= options.tolerance)
      return few_decimals_failure(move, options);
    last = digits;
  }
  return std::nullopt;
}

struct Compensator::State {
  CarriedState carried;
  bool attribution;
};

Compensator::Compensator(const WriteOptions& write, TextReader corrected, bool attribution)
    : state_(new State{{Rewriter(write), std::move(corrected)}, attribution}) {}
Compensator::~Compensator() = default;
Compensator::Compensator(Compensator&&) noexcept = default;

Compensation Compensator::next(const Job& job) {
  WindowWork work;
  begin_window(job, state_->carried, work);
  plan_window(job, work);
  write_window(job, state_->carried, work);
  verify_window(job, state_->attribution, work);
  return std::move(work.result);
}

Compensation compensate(const Job& job, bool attribution) {
  return Compensator(job.options.write, TextReader(job.program, job.read), attribution).next(job);
}

}  // namespace counterflex
