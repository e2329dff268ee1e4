#pragma once
/// The solved correction along one segment, as a curve that can be read anywhere.
#include <functional>
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

/// A stretch without corners: the polynomial through its nodes.
struct CurveInterval {
  std::vector<CurveNode> nodes;
};

class CorrectionCurve {
 public:
  /// The correction at `u`; at a step between two intervals that of the later one.
  Correction at(double u) const;

  double begin() const { return intervals_.front().nodes.front().u; }
  double end() const { return intervals_.back().nodes.back().u; }
  const std::vector<CurveInterval>& intervals() const { return intervals_; }
  void add(CurveInterval interval) { intervals_.push_back(std::move(interval)); }

 private:
  std::vector<CurveInterval> intervals_;
};

/// The polynomial through nodes (Lagrange's form).
Correction polynomial_at(const std::vector<CurveNode>& nodes, double u);

/// Something to be interpolated, at a fraction.
using CorrectionAt = std::function<Correction(double u)>;

/// Knots (fractions, the last one `u1`) such that between them, at sixteenths and at `corners`, the straight
/// line between two of them is within `tolerance` of `at`: as few as possible, then evened out.
std::vector<double> choose_knots(const CorrectionAt& at, double u0, double u1,
                                 const std::vector<double>& corners, double tolerance);

/// The same for a whole correction, `tolerance` in m.
std::vector<double> choose_knots(const CorrectionCurve& curve, const std::vector<double>& corners,
                                 double tolerance);

/// How much of a correction is in effect along a segment: all of it, or evenly less towards an end that stays
/// as programmed. The share multiplies the correction, so that a share of the deviation remains.
struct Fade {
  bool from = false, to = false;  ///< whether the start and the end stay as programmed
  Correction programmed = Correction::Zero();

  bool acts() const { return from || to; }
  Correction operator()(double u, const Correction& full) const {
    if (!acts()) return full;
    const double share = from && to ? 0 : from ? u : 1 - u;
    return programmed + share * (full - programmed);
  }
};

/// Knots of a correction that fades out: the straight lines between them leave at most `tolerance` of the
/// deviation, or not more than without a correction. Both hold for position and turn by themselves.
std::vector<double> choose_knots(const CorrectionCurve& full, const Fade& fade,
                                 const std::vector<double>& corners, double tolerance);

/// `knots` of a curve with those before `first` and behind `last` moved there, but for the one at its end. If
/// the lines between them would miss the tolerance, the knots stay.
std::vector<double> kept_from_ends(const CorrectionCurve& curve, const std::vector<double>& corners,
                                   double tolerance, const std::vector<double>& knots, double first,
                                   double last);

}  // namespace counterflex
