#include "identify/ranges.hpp"

#include <algorithm>
#include <limits>

namespace counterflex {
namespace {

constexpr double margin = 0.1;  // of the trained range: farther out, smooth errors are not known

struct Range {
  double min = std::numeric_limits<double>::infinity(), max = -min;

  void add(double value) { min = std::min(min, value), max = std::max(max, value); }
};

bool has_set(const Actuator& actuator, ParameterSet set) {
  return set == ParameterSet::harmonics ? !actuator.harmonics.empty()
                                        : actuator.errors && actuator.errors->sigma;
}

/// Of an actuator in the rows of a group, and in the others.
struct Ranges {
  Range trained, tested;

  /// How far the tested range is outside, in margins.
  double excess() const {
    if (!(tested.min <= tested.max)) return 0;
    const double out = std::max({trained.min - tested.min, tested.max - trained.max, 0.0});
    return out / std::max(margin * (trained.max - trained.min), std::numeric_limits<double>::min());
  }
};

Ranges ranges_of(const Measurements& measurements, const RowGroup& group, Eigen::Index actuator) {
  std::vector<bool> is_tested(measurements.rows.size(), false);
  for (const std::size_t row : group.rows) is_tested[row] = true;
  Ranges ranges;
  for (std::size_t i = 0; i < measurements.rows.size(); ++i)
    for (const CommandedState& state : measurements.rows[i].states)
      (is_tested[i] ? ranges.tested : ranges.trained).add(state.shown[actuator]);
  return ranges;
}

}  // namespace

bool depends_on_place(ParameterSet set) {
  return set == ParameterSet::tables || set == ParameterSet::harmonics;
}

std::optional<LeftRange> left_range(const FitProblem& problem, const std::vector<RowGroup>& groups,
                                    ParameterSet set) {
  if (!depends_on_place(set)) return {};
  const std::vector<Actuator> all = actuators(problem.machine);
  const std::vector<std::string> names = actuator_names(problem.machine);
  std::optional<LeftRange> found;
  double most = 1;
  for (std::size_t a = 0; a < all.size(); ++a)
    for (const RowGroup& group : groups) {
      if (!has_set(all[a], set)) continue;
      const Ranges ranges = ranges_of(problem.measurements, group, static_cast<Eigen::Index>(a));
      if (!(ranges.excess() > most)) continue;
      most = ranges.excess();
      found = LeftRange{group.name,         names[a],           all[a].joint.kind == JointKind::revolute,
                        ranges.trained.min, ranges.trained.max, ranges.tested.min,
                        ranges.tested.max};
    }
  return found;
}

}  // namespace counterflex
