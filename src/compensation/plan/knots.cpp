#include "compensation/plan/knots.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <utility>

#include "compensation/solve/failures.hpp"
#include "compensation/tuning.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

// A gain that is measured at one place: in steps small against any curvature, with a margin for the places
// beside it.
constexpr double gain_probe = 50e-6;  // m
constexpr double gain_margin = 1 + curve_share;

// Whether a straight line between two fractions is near enough.
using IsStraight = std::function<bool(double u0, double u1)>;

// At sixteenths and at corners. The middle comes first: a line that is too long mostly shows it there.
template <typename Holds>
bool holds_between(double u0, double u1, const std::vector<double>& corners, const Holds& holds) {
  for (const int k : {8, 4, 12, 2, 6, 10, 14, 1, 3, 5, 7, 9, 11, 13, 15})
    if (!holds(u0 + (u1 - u0) * k / 16)) return false;
  return std::all_of(corners.begin(), corners.end(),
                     [&](double corner) { return !(corner > u0 && corner < u1) || holds(corner); });
}

// The same within a tolerance. `at` has corners at `corners`.
bool stays_within(const CorrectionAt& at, const std::vector<double>& corners, double u0, double u1,
                  double tolerance) {
  const Correction c0 = at(u0), c1 = at(u1);
  return holds_between(u0, u1, corners, [&](double u) {
    const double w = (u - u0) / (u1 - u0);
    return (at(u) - (1 - w) * c0 - w * c1).norm() <= tolerance;
  });
}

// The farthest end to which a straight line goes from u0.
double reach(const IsStraight& is_straight, double u0, double end) {
  if (is_straight(u0, end)) return end;
  double good = u0, bad = end;
  for (int k = 0; k < 40 && bad - good > 1e-6; ++k) {
    const double u = (good + bad) / 2;
    (is_straight(u0, u) ? good : bad) = u;
  }
  return good > u0 ? good : bad;
}

std::vector<double> greedy(const IsStraight& is_straight, double u0, double end) {
  std::vector<double> knots;
  for (double u = u0; u < end;) {
    u = reach(is_straight, u, end);
    knots.push_back(u);
  }
  return knots;
}

// Whether what a correction leaves is within the tolerance, or a share of the deviation without it. In
// another direction the band may be smaller.
template <int first>
bool leaves_little(const Correction& left, const Correction& without, double tolerance, double accuracy) {
  const Vector3 l = left.segment<3>(first), w = without.segment<3>(first);
  if (l.norm() <= tolerance) return true;
  const double share = std::clamp(l.dot(w) / w.squaredNorm(), 0.0, 1.0);
  return (l - share * w).norm() <= accuracy;
}

// Knots of a correction that fades out: the straight lines between them leave at most `room` of the
// deviation, or a share of it to `accuracy`. Both hold for position and turn by themselves.
std::vector<double> fading_knots(const CorrectionCurve& full, const Fade& fade,
                                 const std::vector<double>& corners, double room, double accuracy) {
  const auto is_straight = [&](double u0, double u1) {
    const Correction c0 = fade(u0, full.at(u0)), c1 = fade(u1, full.at(u1));
    return holds_between(u0, u1, corners, [&](double u) {
      const double w = (u - u0) / (u1 - u0);
      const Correction c = full.at(u), left = c - (1 - w) * c0 - w * c1, without = c - fade.programmed;
      return leaves_little<0>(left, without, room, accuracy) &&
             leaves_little<3>(left, without, room, accuracy);
    });
  };
  return greedy(is_straight, full.begin(), full.end());
}

// `knots` with those before `first` and behind `last` moved there, but for the one at the end. If the lines
// between them are not near enough then, the knots stay.
std::vector<double> kept_from_ends(const IsStraight& is_straight, double begin,
                                   const std::vector<double>& knots, double first, double last) {
  std::vector<double> moved;
  double before = begin;
  for (const double knot : knots) {
    const double u = knot < knots.back() ? std::clamp(knot, first, last) : knot;
    if (u <= before) continue;
    if (!is_straight(before, u)) return knots;
    moved.push_back(before = u);
  }
  return moved;
}

// Fractions between which points are two zones away from the ends of the segment.
std::pair<double, double> between_zones(const Job& job, const Segment& segment) {
  const double length = (segment.wanted.end - segment.wanted.start).norm();
  const auto twice = [&](const Move* move) {
    return move != nullptr && move->zone ? 2 * move->zone->length_mm * mm / length : 0;
  };
  return {twice(move_before(job.program, segment.move)), 1 - twice(&job.program.moves[segment.move])};
}

}  // namespace

std::vector<double> choose_knots(const CorrectionAt& at, double u0, double u1,
                                 const std::vector<double>& corners, double tolerance) {
  const auto knots_within = [&](double most) {
    return greedy([&](double a, double b) { return stays_within(at, corners, a, b, most); }, u0, u1);
  };
  std::vector<double> knots = knots_within(tolerance);
  if (knots.size() < 2) return knots;
  double low = 0, high = tolerance;  // the least tolerance that needs no more knots
  for (int k = 0; k < 8; ++k) {
    const double middle = (low + high) / 2;
    std::vector<double> even = knots_within(middle);
    if (even.size() > knots.size()) {
      low = middle;
    } else {
      high = middle;
      knots = std::move(even);
    }
  }
  return knots;
}

double room_for_knots(const Job& job, const Segment& segment) {
  return room_between_points(job, segment, 1).value_or(curve_share * job.options.tolerance);
}

std::optional<double> room_between_points(const Job& job, const Segment& segment, double gain) {
  const double rounding = rounding_allowance(job.program.moves[segment.move], job.options.write);
  // The sampled correction may miss the corners of knees.
  const double off = model_of(job, segment).mechanism.has_knees ? curve_share * job.options.tolerance : 0;
  const double room = job.options.tolerance / gain - rounding - off;
  if (room < curve_share * job.options.tolerance) return std::nullopt;
  return room;
}

std::optional<Failure> add_knots(const Job& job, PlaceSolver& solver, std::size_t index,
                                 const CorrectionCurve& stretch, const Fade& fade,
                                 const std::vector<double>& corners, PlannedSegment& planned) {
  const Segment& segment = job.path.segments[index];
  const CorrectionAt at = [&stretch](double u) { return stretch.at(u); };
  const auto knots_within = [&](double room) {
    return choose_knots(at, stretch.begin(), stretch.end(), corners, room);
  };
  std::vector<double> knots;
  if (!fade.acts()) knots = knots_within(room_for_knots(job, segment));
  if (fade.acts() || knots.size() > 1) {
    double gain = 1;
    if (auto failure = set_gain(job, solver, index, gain)) return failure;
    const std::optional<double> room = room_between_points(job, segment, gain);
    if (!room) return few_decimals_failure(job.program.moves[segment.move], job.options);
    knots = fade.acts() ? fading_knots(stretch, fade, corners, *room, curve_share * job.options.tolerance)
                        : knots_within(*room);
    // Where that is not possible the zones become smaller.
    const auto [first, last] = between_zones(job, segment);
    const auto is_straight = [&](double u0, double u1) { return stays_within(at, corners, u0, u1, *room); };
    if (!fade.acts() && first < last)
      knots = kept_from_ends(is_straight, stretch.begin(), knots, first, last);
  }
  for (const double u : knots)
    planned.knots.push_back({command_at(job, segment, u, fade(u, stretch.at(u))), u});
  return std::nullopt;
}

// Where the cell of the place gives no bound the largest singular value is measured.
std::optional<Failure> set_gain(const Job& job, PlaceSolver& solver, std::size_t index, double& gain) {
  const Segment& segment = job.path.segments[index];
  const Model& model = model_of(job, segment);
  const Vector3& end = segment.wanted.end;
  const Vector6 F = job.forces.at(index, 1);
  const std::optional<Matrix3> R = orientation_at(segment, 1);
  gain = R ? HUGE_VAL : solver.bend_along(model, {end, end, F, F, {}}).gain;
  if (std::isfinite(gain)) return std::nullopt;
  std::array<ForwardRequest, 6> requests;
  std::array<ForwardAnswer, 6> reached;
  for (std::size_t k = 0; k < 6; ++k) {
    const Vector3 aside = (k % 2 != 0 ? -gain_probe : gain_probe) * Vector3::Unit(k / 2);
    requests[k] = {.model = &model, .target = end + aside, .F = F, .R = R};
  }
  solver.forwards(requests, reached);
  Matrix3 J;
  for (std::size_t k = 0; k < 6; ++k) {
    if (reached[k].status != Status::converged)
      return status_failure(job, reached[k].status, segment, requests[k].target);
    if (k % 2 != 0) J.col(k / 2) = (reached[k - 1].X_MT.p - reached[k].X_MT.p) / (2 * gain_probe);
  }
  gain = gain_margin * Eigen::JacobiSVD<Matrix3>(J).singularValues()[0];
  return std::nullopt;
}

void forbid_splitting(const Segment& segment, PlannedSegment& planned) {
  if (planned.knots.size() < 2) return;
  const Vector3 c0 = planned.start.target - segment.wanted.start,
                c1 = planned.knots.back().target - segment.wanted.end;
  for (const Knot& knot : planned.knots) {
    const Vector3 c = knot.target - point_at(segment.wanted, knot.u);
    planned.unsplit_miss = std::max(planned.unsplit_miss, (c - (1 - knot.u) * c0 - knot.u * c1).norm());
  }
  planned.knots.erase(planned.knots.begin(), planned.knots.end() - 1);
}

}  // namespace counterflex
