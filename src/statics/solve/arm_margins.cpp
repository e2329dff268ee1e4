#include "counterflex/statics/arm_margins.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

// Of the machine's length, or rad: axes have one point, or are parallel. Calibrations find some millimetres
// and milliradians; wrists whose axes do not meet have offsets of 2 % and more.
constexpr double meets = 5e-3;

// The axis of a rotary joint: a unit vector, and a point from the tip (m).
struct Line {
  Vector3 axis, point;
};

bool is_arm(const Mechanism& mechanism) {
  return mechanism.chains.size() == 1 && mechanism.controlled.size() == 6 && mechanism.travel.size() == 6 &&
         std::all_of(mechanism.travel.begin(), mechanism.travel.end(),
                     [](const Travel& travel) { return travel.kind == JointKind::revolute; });
}

// A joint at the point q turns the tip by its axis w and moves it by v = w x (tip - q): so w x v leads from
// the tip to the axis.
std::array<Line, 6> axes_of(const Eigen::MatrixXd& J) {
  std::array<Line, 6> lines;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Vector6 twist = J.col(static_cast<Eigen::Index>(i));
    lines[i].axis = twist.tail<3>().normalized();
    lines[i].point = lines[i].axis.cross(Vector3(twist.head<3>()));
  }
  return lines;
}

// The point of line `a` that is nearest to line `b`, which is not parallel to it.
Vector3 nearest_point(const Line& a, const Line& b) {
  const Vector3 across = a.axis.cross(b.axis), way = b.point - a.point;
  return a.point + a.axis * (way.cross(b.axis).dot(across) / across.squaredNorm());
}

Vector3 to_line(const Vector3& from, const Line& line) {
  const Vector3 way = line.point - from;
  return way - way.dot(line.axis) * line.axis;
}

// Between two directions, from the nearer of parallel and opposite.
double angle_from_line(const Vector3& a, const Vector3& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

bool are_parallel(const Line& a, const Line& b) {
  return a.axis.cross(b.axis).norm() < meets;
}

// An arm whose last three axes meet in `centre`, from the tip.
std::array<ArmMargin, 3> margins_of_common_wrist(const std::array<Line, 6>& axes, const Vector3& centre) {
  const Vector3 &a2 = axes[1].axis, to_2 = to_line(centre, axes[1]), to_3 = to_line(centre, axes[2]);
  const auto in_plane = [&](const Vector3& v) { return Vector3(v - v.dot(a2) * a2); };
  const Vector3 forearm = in_plane(to_3), upper_arm = in_plane(to_2) - forearm;
  const double reach = forearm.norm() + upper_arm.norm();
  return {ArmMargin{angle_from_line(axes[3].axis, axes[5].axis), "wrist: axes A4 and A6 are in line"},
          ArmMargin{angle_from_line(forearm, upper_arm), "elbow: the arm is stretched or folded"},
          ArmMargin{std::atan2(to_line(centre, axes[0]).norm(), reach),
                    "shoulder: the centre of the wrist is on axis A1"}};
}

// An arm whose axes 2, 3 and 4 are parallel, as those of Universal Robots. Two configurations meet where the
// point of axes 5 and 6 is in the plane of axes 1 and 2.
std::array<ArmMargin, 3> margins_of_parallel_axes(const std::array<Line, 6>& axes) {
  const Vector3 centre = nearest_point(axes[5], axes[4]);
  const Vector3 to_2 = to_line(centre, axes[1]), to_3 = to_line(centre, axes[2]),
                to_4 = to_line(centre, axes[3]), upper_arm = to_3 - to_2, forearm = to_4 - to_3;
  const Vector3 across = axes[0].axis.cross(axes[1].axis).normalized();
  const double reach = forearm.norm() + upper_arm.norm();
  return {ArmMargin{angle_from_line(axes[3].axis, axes[5].axis), "wrist: axes A4 and A6 are parallel"},
          ArmMargin{angle_from_line(forearm, upper_arm), "elbow: the arm is stretched or folded"},
          ArmMargin{std::atan2(std::abs(to_line(centre, axes[0]).dot(across)), reach),
                    "shoulder: the wrist is in the plane of axes A1 and A2"}};
}

}  // namespace

std::optional<std::array<ArmMargin, 3>> arm_margins(const Model& model, const Configuration& nominal) {
  if (!is_arm(model.mechanism)) return std::nullopt;
  const std::array<Line, 6> axes = axes_of(actuator_jacobian(model, nominal).J);
  if (are_parallel(axes[1], axes[2]) && are_parallel(axes[2], axes[3])) return margins_of_parallel_axes(axes);
  const Vector3 centre = nearest_point(axes[4], axes[3]);
  for (const std::size_t i : {3u, 5u})
    if (!(to_line(centre, axes[i]).norm() < meets * model.mechanism.length)) return std::nullopt;
  return margins_of_common_wrist(axes, centre);
}

std::optional<ArmMargin> arm_margin(const Model& model, const Configuration& nominal) {
  const auto margins = arm_margins(model, nominal);
  if (!margins) return std::nullopt;
  return *std::min_element(margins->begin(), margins->end(),
                           [](const ArmMargin& a, const ArmMargin& b) { return a.angle < b.angle; });
}

}  // namespace counterflex
