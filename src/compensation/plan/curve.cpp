#include "compensation/plan/curve.hpp"

#include <algorithm>
#include <cmath>

namespace counterflex {
namespace {

// A vector to be interpolated linearly between knots, with the places where it has corners.
struct Interpolated {
  const CorrectionAt& at;
  const std::vector<double>& corners;
};

// At sixteenths and at corners. The middle comes first: a line that is too long mostly shows it there.
bool stays_within(const Interpolated& curve, double u0, double u1, double tolerance) {
  const Correction c0 = curve.at(u0), c1 = curve.at(u1);
  const auto holds = [&](double u) {
    const double w = (u - u0) / (u1 - u0);
    return (curve.at(u) - (1 - w) * c0 - w * c1).norm() <= tolerance;
  };
  for (const int k : {8, 4, 12, 2, 6, 10, 14, 1, 3, 5, 7, 9, 11, 13, 15})
    if (!holds(u0 + (u1 - u0) * k / 16)) return false;
  return std::all_of(curve.corners.begin(), curve.corners.end(),
                     [&](double corner) { return !(corner > u0 && corner < u1) || holds(corner); });
}

// The farthest end that a straight line from u0 reaches within the tolerance.
double reach(const Interpolated& curve, double u0, double end, double tolerance) {
  if (stays_within(curve, u0, end, tolerance)) return end;
  double good = u0, bad = end;
  for (int k = 0; k < 40 && bad - good > 1e-6; ++k) {
    const double u = (good + bad) / 2;
    (stays_within(curve, u0, u, tolerance) ? good : bad) = u;
  }
  return good > u0 ? good : bad;
}

std::vector<double> greedy(const Interpolated& curve, double u0, double end, double tolerance) {
  std::vector<double> knots;
  for (double u = u0; u < end;) {
    u = reach(curve, u, end, tolerance);
    knots.push_back(u);
  }
  return knots;
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
