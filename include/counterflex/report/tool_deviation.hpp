#pragma once
/// What the tilt of a tool does beside its tip: at the rim of the cutter, and along its flank.
#include <optional>

#include "counterflex/geometry/types.hpp"

namespace counterflex {

/// How large a tool is (m); what is not known is empty.
struct ToolSize {
  long number = 0;                  ///< in the program; 0: none known
  std::optional<double> diameter{};
  std::optional<double> flute{};    ///< length of the cutting edges, from the tip along the axis
};

/// The largest displacement (m) of a circle of `radius` around the tool's axis, `height` above the tip
/// towards the spindle, where the tip's deviation is (d, phi):
///
///     max over alpha of |d + phi x r|,   r = height a + radius (cos(alpha) u + sin(alpha) v)
///
/// a, u and v unit vectors, u and v square to the axis a. A turn of the tool about its own axis is left out:
/// it moves no point of the surface that the turning cutter sweeps. With phi square to a the second part of
/// phi x r lies along a and reaches radius |phi| on either side, so that the maximum is
///
///     sqrt(|b - (d.a) a|^2 + (|d.a| + radius |phi|)^2),   b = d + height phi x a
double largest_on_circle(const Vector6& deviation, const Vector3& axis, double radius, double height);

/// The largest deviations of a tool along a path: of its tip, of the rim at its tip, and of its flank where the
/// cutting edges end. Lengths in mm, angles in degrees; rim and flank are empty where the tool's size is not
/// known.
struct ToolDeviation {
  double tip_mm = 0;
  std::optional<double> rim_mm{}, flank_mm{};
  double tilt_deg = 0;  ///< of the tool's axis
  int line = 0;         ///< where the largest of tip, rim and flank is; the first such line

  double largest_mm() const;
};

/// Collects the deviations of one tool.
class ToolDeviationTally {
 public:
  void add(const ToolSize& size, const Vector6& deviation, const Vector3& axis, int line);

  /// Empty before the first one.
  const std::optional<ToolDeviation>& largest() const { return largest_; }

 private:
  std::optional<ToolDeviation> largest_;
};

}  // namespace counterflex
