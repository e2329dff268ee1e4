#include "compensation/plan/curve.hpp"

#include <algorithm>
#include <cmath>

namespace counterflex {
namespace {

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

// A vector to be interpolated linearly between knots, with the places where it has corners.
struct Interpolated {
  const CorrectionAt& at;
  const std::vector<double>& corners;
};

bool stays_within(const Interpolated& curve, double u0, double u1, double tolerance) {
  const Correction c0 = curve.at(u0), c1 = curve.at(u1);
  return holds_between(u0, u1, curve.corners, [&](double u) {
    const double w = (u - u0) / (u1 - u0);
    return (curve.at(u) - (1 - w) * c0 - w * c1).norm() <= tolerance;
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

std::vector<double> greedy(const Interpolated& curve, double u0, double end, double tolerance) {
  return greedy([&](double a, double b) { return stays_within(curve, a, b, tolerance); }, u0, end);
}

// Whether what a correction leaves is within the tolerance, or not more than without it.
template <int first>
bool leaves_little(const Correction& left, const Correction& without, double tolerance) {
  return left.segment<3>(first).norm() <= std::max(tolerance, without.segment<3>(first).norm());
}

}  // namespace

Correction polynomial_at(const std::vector<CurveNode>& nodes, double u) {
  Correction sum = Correction::Zero();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    double weight = 1;
    for (std::size_t j = 0; j < nodes.size(); ++j)
      if (j != i) weight *= (u - nodes[j].u) / (nodes[i].u - nodes[j].u);
    sum += weight * nodes[i].c;
  }
  return sum;
}

Correction CorrectionCurve::at(double u) const {
  const auto after = std::upper_bound(intervals_.begin(), intervals_.end(), u,
                                      [](double v, const CurveInterval& i) { return v < i.nodes.back().u; });
  const CurveInterval& interval = after == intervals_.end() ? intervals_.back() : *after;
  return polynomial_at(interval.nodes, u);
}

std::vector<double> choose_knots(const CorrectionAt& at, double u0, double u1,
                                 const std::vector<double>& corners, double tolerance) {
  const Interpolated curve{at, corners};
  std::vector<double> knots = greedy(curve, u0, u1, tolerance);
  if (knots.size() < 2) return knots;
  double low = 0, high = tolerance;  // the least tolerance that needs no more knots
  for (int k = 0; k < 8; ++k) {
    const double middle = (low + high) / 2;
    std::vector<double> even = greedy(curve, u0, u1, middle);
    if (even.size() > knots.size()) {
      low = middle;
    } else {
      high = middle;
      knots = std::move(even);
    }
  }
  return knots;
}

std::vector<double> choose_knots(const CorrectionCurve& curve, const std::vector<double>& corners,
                                 double tolerance) {
  const CorrectionAt at = [&curve](double u) { return curve.at(u); };
  return choose_knots(at, curve.begin(), curve.end(), corners, tolerance);
}

std::vector<double> choose_knots(const CorrectionCurve& full, const Fade& fade,
                                 const std::vector<double>& corners, double tolerance) {
  const auto is_straight = [&](double u0, double u1) {
    const Correction c0 = fade(u0, full.at(u0)), c1 = fade(u1, full.at(u1));
    return holds_between(u0, u1, corners, [&](double u) {
      const double w = (u - u0) / (u1 - u0);
      const Correction c = full.at(u), left = c - (1 - w) * c0 - w * c1, without = c - fade.programmed;
      return leaves_little<0>(left, without, tolerance) && leaves_little<3>(left, without, tolerance);
    });
  };
  return greedy(is_straight, full.begin(), full.end());
}

std::vector<double> kept_from_ends(const CorrectionCurve& curve, const std::vector<double>& corners,
                                   double tolerance, const std::vector<double>& knots, double first,
                                   double last) {
  const CorrectionAt at = [&curve](double u) { return curve.at(u); };
  std::vector<double> moved;
  double before = curve.begin();
  for (const double knot : knots) {
    const double u = knot < curve.end() ? std::clamp(knot, first, last) : knot;
    if (u <= before) continue;
    if (!stays_within({at, corners}, before, u, tolerance)) return knots;
    moved.push_back(before = u);
  }
  return moved;
}

}  // namespace counterflex
