#pragma once
/// The solved correction along one segment, as a curve that can be read anywhere.
#include <algorithm>
#include <vector>

#include "counterflex/geometry/types.hpp"

namespace counterflex {

/// Command minus wanted place, axes of M: position (m), and rotation vector by its lever (m): zero where the
/// program gives no orientation. So its norm is what a tolerance is for.
using Correction = Vector6;

inline Vector3 shift_of(const Correction& c) {
  return c.head<3>();
}

struct CurveNode {
  double u = 0;  ///< fraction of the segment
  Correction c = Correction::Zero();
};

/// A stretch without corners: the nodes of its polynomial.
using CurveInterval = std::vector<CurveNode>;

/// The polynomial through nodes (Lagrange's form).
inline Correction polynomial_at(const CurveInterval& nodes, double u) {
  Correction sum = Correction::Zero();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    double weight = 1;
    for (std::size_t j = 0; j < nodes.size(); ++j)
      if (j != i) weight *= (u - nodes[j].u) / (nodes[i].u - nodes[j].u);
    sum += weight * nodes[i].c;
  }
  return sum;
}

class CorrectionCurve {
 public:
  /// The correction at `u`; at a step between two intervals that of the later one.
  Correction at(double u) const {
    const auto after = std::upper_bound(intervals_.begin(), intervals_.end(), u,
                                        [](double v, const CurveInterval& i) { return v < i.back().u; });
    return polynomial_at(after == intervals_.end() ? intervals_.back() : *after, u);
  }

  double begin() const { return intervals_.front().front().u; }
  double end() const { return intervals_.back().back().u; }
  void add(CurveInterval interval) { intervals_.push_back(std::move(interval)); }

 private:
  std::vector<CurveInterval> intervals_;
};

}  // namespace counterflex
