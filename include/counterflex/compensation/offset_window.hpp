#pragma once
/// By how much a work offset and a tool length may differ from those for which a program was corrected.
#include <cstddef>
#include <optional>
#include <vector>

#include "counterflex/compensation/loads_along.hpp"

namespace counterflex {

/// The half-widths that are tried, in mm, from the largest to the smallest: no window is wider, and none
/// below the last one is of use, as no offset is set more finely.
inline constexpr double window_steps_mm[] = {
    10,   8,   6,    5,    4,   3,    2.5,  2,    1.5,  1.2,  1,     0.8,  0.6,   0.5,   0.4, 0.3,
    0.25, 0.2, 0.15, 0.12, 0.1, 0.08, 0.06, 0.05, 0.04, 0.03, 0.025, 0.02, 0.015, 0.012, 0.01};

/// What is shifted.
struct OffsetQuestion {
  const std::vector<LoadPlace>& places;  ///< of the corrected program
  const CompensationOptions& options;
  const Machine& machine;
  const Model& model;                    ///< without a tool
  const std::vector<WorkFrame>& frames;  ///< by index into Program::frames
  std::optional<long> tool{};  ///< whose length may differ, too: one that makes the machine another one
  bool turns = false;          ///< the angles of the frames may differ by `guarded_angle_deg`
  const StartTables* starts = nullptr;  ///< as for a job
};

/// The largest half-width (m) of `window_steps_mm` whose corners hold. The part moves with the offset: the
/// commands of the corrected program and the wanted path are shifted together, along the axes of the work
/// frame and along those of M, and the machine is solved forward. A corner holds if the deviation is within
/// the tolerances at each place, and the actuators within their travel. At a place that need not keep the
/// tolerances (`Waypoint::exempt`, `Waypoint::insignificant`) the deviation may exceed them, or its value
/// with the exact offset if that is larger, by a tenth of them. A datum that was touched off is touched off
/// again at its new place. Corners of the tool length are those of the window with the length changed by the
/// same half-width. Empty: not even the smallest one holds.
std::optional<double> offset_window(const OffsetQuestion& question);

/// Whether all corners of one half-width hold (m).
bool window_holds(const OffsetQuestion& question, double half_width);

}  // namespace counterflex
