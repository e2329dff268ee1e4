#include "compensation/plan/places.hpp"

#include <algorithm>
#include <cmath>

#include "compensation/tuning.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

constexpr int most_by_length = 64;  // a program of 100 kB may hold 20 000 moves across the whole machine
constexpr double same_fraction = 1e-9;

}  // namespace

int steps_of_tables(const Job& job, const Segment& segment) {
  const Mechanism& mechanism = model_of(job, segment).mechanism;
  if (std::isinf(mechanism.error_spacing) && std::isinf(mechanism.error_spacing_angle)) return 1;
  const double way = length(segment.wanted), turned = way / mechanism.length + turn_of(segment);
  const double steps = std::ceil(way / mechanism.error_spacing + turned / mechanism.error_spacing_angle);
  return static_cast<int>(std::clamp(steps, 1.0, most_steps));
}

int steps_along(const Job& job, const Segment& segment) {
  if (!segment.cutting) return 1;
  const double by_length =
      std::clamp(std::ceil((segment.s_end - segment.s_start) / between_places), 1.0, double{most_by_length});
  const double angle = std::max(segment.wanted.arc ? segment.wanted.arc->sweep : 0.0, turn_of(segment));
  const double by_angle = std::ceil(angle / angle_between_places);
  return std::max(static_cast<int>(std::max(by_length, by_angle)), steps_of_tables(job, segment));
}

void places_along(const Job& job, std::size_t index, ForceCursor& cursor, std::vector<double>& fractions) {
  const Segment& segment = job.path.segments[index];
  fractions.clear();
  if (segment.cutting) {
    std::vector<double> reversals;
    if (job.directions != nullptr) job.directions->inside(segment.move, reversals);
    job.forces.breaks(index, cursor, fractions);
    fractions.insert(fractions.end(), reversals.begin(), reversals.end());
    const int steps = steps_along(job, segment);
    for (int k = 1; k < steps; ++k) fractions.push_back(static_cast<double>(k) / steps);
    std::sort(fractions.begin(), fractions.end());
    const auto same = [](double a, double b) { return b - a < same_fraction; };
    fractions.erase(std::unique(fractions.begin(), fractions.end(), same), fractions.end());
  }
  fractions.push_back(1);
}

std::vector<Vector6> force_bends(const Job& job, const ForceChord& stretch, std::span<const double> corners,
                                 ForceCursor& cursor) {
  std::vector<Vector6> bends;
  const auto add = [&](double u) {
    const double v = (u - stretch.u0) / (stretch.u1 - stretch.u0);
    const Vector6 F = job.forces.at(stretch.segment, u, Side::before, cursor);
    bends.emplace_back(F - (1 - v) * stretch.F0 - v * stretch.F1);
  };
  for (const double u : corners) add(u);
  for (int k = 1; k < eighths && !job.forces.is_linear_between_breaks(); ++k)
    add(stretch.u0 + static_cast<double>(k) / eighths * (stretch.u1 - stretch.u0));
  return bends;
}

}  // namespace counterflex
