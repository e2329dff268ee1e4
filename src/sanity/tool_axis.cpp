#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "counterflex/geometry/types.hpp"
#include "counterflex/sanity/checks.hpp"

namespace counterflex {
namespace {

constexpr double into_the_work = 90 + 1e-3;  // deg: a tool exactly perpendicular to z is allowed
constexpr double far_from_upright = 45;      // deg: implausible for a machine of linear axes

double angle_deg(const Vector3& a, const Vector3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) / deg;
}

struct LargestAngle {
  double deg = -1;
  std::string z;  ///< name of the axis: "G54 z"
};

LargestAngle largest_angle(const std::vector<const Model*>& models, const std::vector<WorkFrame>& frames) {
  LargestAngle largest;
  for (const Model* model : models) {
    const Vector3 axis = tip(model->mechanism, model->home).R.col(2);
    const auto compare = [&](const Vector3& z, const std::string& name) {
      const double angle = angle_deg(axis, z);
      if (angle > largest.deg) largest = {angle, name};
    };
    for (const WorkFrame& frame : frames)
      compare(frame.X_MW.R.col(2), frame.name.empty() ? "machine z" : frame.name + " z");
    if (frames.empty()) compare(Vector3::UnitZ(), "machine z");
  }
  return largest;
}

}  // namespace

SanityCheck check_tool_axis(const std::vector<const Model*>& models, const std::vector<WorkFrame>& frames,
                            bool turns_joints, bool allowed) {
  const LargestAngle largest = largest_angle(models, frames);
  const std::string angle =
      fmt::format("the angle from {} to the tool's z is {:.1f} deg", largest.z, largest.deg + 0.0);
  if (largest.deg > into_the_work && !allowed)
    return {"tool axis", SanityState::wrong,
            fmt::format(
                "the tool points into the work: {}, at most 90 deg is allowed; the tip's z must point "
                "from the tip to the spindle: turn [tool] by 180 deg about its x (rpy_deg), give [tool] "
                "spindle_axis = \"-z\" if the control's tool frame points out of the tool, or allow_inverted "
                "= true",
                angle)};
  if (largest.deg >= far_from_upright && !turns_joints && !allowed)
    return {"tool axis", SanityState::doubtful,
            fmt::format("{}; on a machine of linear axes it is usually 0: check rpy_deg of [tool] and of the "
                        "work offset",
                        angle)};
  return {"tool axis", SanityState::ok, angle};
}

}  // namespace counterflex
