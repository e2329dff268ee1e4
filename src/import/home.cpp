#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "counterflex/geometry/types.hpp"
#include "import/serial_arm.hpp"

namespace counterflex::import {
namespace {

using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;

constexpr std::size_t most_varied = 6;  // joints: 5^6 poses take some hundredths of a second
constexpr double regular_from = 1e-3;   // manipulability
constexpr double good_share = 0.5;      // of the best manipulability

/// Columns (v, w) of the tip by joint values, lengths in units of `length`; and the orientation of the last
/// frame.
struct TipMotion {
  Jacobian J;
  Matrix3 R_MP = Matrix3::Identity();
};

TipMotion tip_motion(const SerialArm& arm, const std::vector<double>& values, double length) {
  std::vector<Vector3> origins, axes;
  Pose X;
  const auto go = [&](const std::vector<FixedTransform>& list) {
    for (const FixedTransform& fixed : list) X = X * fixed.pose();
  };
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    const ArmJoint& joint = arm.joints[i];
    go(joint.before);
    origins.push_back(X.p);
    axes.push_back(X.R * joint.joint.axis);
    X = X * (joint.joint.kind == JointKind::revolute ? rotation(exp_so3(joint.joint.axis * values[i]))
                                                     : translation(joint.joint.axis * values[i]));
    go(joint.after);
  }
  go(arm.end);
  Jacobian J(6, static_cast<Eigen::Index>(arm.joints.size()));
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    const bool turns = arm.joints[i].joint.kind == JointKind::revolute;
    J.col(static_cast<Eigen::Index>(i))
        << (turns ? Vector3(axes[i].cross(X.p - origins[i]) / length) : axes[i]),
        (turns ? axes[i] : Vector3::Zero().eval());
  }
  return {J, X.R};
}

double least_singular_value(const Eigen::MatrixXd& J) {
  return Eigen::JacobiSVD<Eigen::MatrixXd>(J).singularValues().minCoeff();
}

/// Of the best set of as many components as there are joints, the first in the order of names among sets that
/// are nearly as good.
std::vector<Component> best_components(const Jacobian& J, double& measure) {
  const int n = static_cast<int>(std::min<Eigen::Index>(J.cols(), 6));
  std::vector<std::pair<double, std::vector<Component>>> sets;
  for (unsigned bits = 0; bits < 64; ++bits) {
    std::vector<Component> set;
    for (int i = 0; i < 6; ++i)
      if ((bits >> (5 - i) & 1U) != 0) set.push_back(static_cast<Component>(i));
    if (static_cast<int>(set.size()) != n) continue;
    Eigen::MatrixXd rows(n, J.cols());
    for (int i = 0; i < n; ++i) rows.row(i) = J.row(static_cast<int>(set[static_cast<std::size_t>(i)]));
    sets.emplace_back(least_singular_value(rows), set);
  }
  const double best = std::max_element(sets.begin(), sets.end())->first;
  std::sort(sets.begin(), sets.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  const auto found =
      std::find_if(sets.begin(), sets.end(), [&](const auto& set) { return set.first >= good_share * best; });
  measure = best;
  return found->second;
}

/// Zero, or the middle of a travel that does not contain it.
double rest_value(const ArmJoint& joint) {
  if (joint.home) return *joint.home;
  const bool contains_zero = joint.min.value_or(-1) <= 0 && joint.max.value_or(1) >= 0;
  const bool turns = joint.joint.kind == JointKind::revolute;
  if (joint.min && joint.max && (!turns || !contains_zero)) return (*joint.min + *joint.max) / 2;
  if (contains_zero) return 0;
  return joint.min ? std::max(*joint.min, 0.0) : std::min(*joint.max, 0.0);
}

std::vector<double> candidates(const ArmJoint& joint, bool varied) {
  std::vector<double> values = {rest_value(joint)};
  if (joint.home || !varied) return values;
  if (joint.joint.kind == JointKind::prismatic) {
    if (joint.min && joint.max)
      for (const double share : {0.25, 0.75})
        values.push_back(*joint.min + share * (*joint.max - *joint.min));
    return values;
  }
  for (const double angle : {45 * deg, -45 * deg, 90 * deg, -90 * deg})
    if (angle >= joint.min.value_or(-pi) && angle <= joint.max.value_or(pi)) values.push_back(angle);
  return values;
}

struct TriedPose {
  std::vector<double> shown;
  double measure = 0;
  bool tool_down = false;  ///< the spindle axis leans at most 60 degrees from z of M
  double distance = 0;     ///< from the rest values, rad
};

/// All combinations of the candidates. The first and the last rotary joint have no influence on the measure.
std::vector<TriedPose> tried_poses(const SerialArm& arm, double length) {
  const std::size_t n = arm.joints.size();
  std::vector<std::vector<double>> values;
  std::size_t varied = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const bool inner = i > 0 && i + 1 < n && varied < most_varied;
    values.push_back(candidates(arm.joints[i], inner));
    varied += inner ? 1 : 0;
  }
  std::vector<TriedPose> poses;
  std::vector<std::size_t> index(n, 0);
  for (bool more = true; more;) {
    TriedPose pose;
    for (std::size_t i = 0; i < n; ++i) {
      pose.shown.push_back(values[i][index[i]]);
      pose.distance += std::abs(values[i][index[i]] - values[i][0]);
    }
    const TipMotion motion = tip_motion(arm, joint_values(arm.joints, pose.shown), length);
    best_components(motion.J, pose.measure);
    constexpr double least_cosine = 0.5 - 1e-9;
    pose.tool_down = (arm.spindle_axis == "-z" ? -1 : 1) * motion.R_MP(2, 2) >= least_cosine;
    poses.push_back(std::move(pose));
    more = false;
    for (std::size_t i = 0; i < n && !more; ++i) {
      index[i] = (index[i] + 1) % values[i].size();
      more = index[i] != 0;
    }
  }
  return poses;
}

}  // namespace

std::vector<double> joint_values(const std::vector<ArmJoint>& joints, const std::vector<double>& shown) {
  std::vector<double> values = shown;
  for (std::size_t i = 0; i < joints.size(); ++i)
    for (const auto& [other, factor] : joints[i].shown_with) values[i] -= factor * shown[other];
  return values;
}

double reach(const SerialArm& arm, std::size_t from) {
  double length = 0;
  for (std::size_t i = from; i < arm.joints.size(); ++i) {
    if (i > from)
      for (const FixedTransform& fixed : arm.joints[i].before) length += fixed.xyz.norm();
    for (const FixedTransform& fixed : arm.joints[i].after) length += fixed.xyz.norm();
  }
  for (const FixedTransform& fixed : arm.end) length += fixed.xyz.norm();
  return length;
}

ArmHome choose_home(const SerialArm& arm) {
  const double length = std::max(reach(arm, 0) / 2, 0.05);
  const std::vector<TriedPose> poses = tried_poses(arm, length);
  const auto by_measure = [](const TriedPose& a, const TriedPose& b) { return a.measure < b.measure; };
  const double best = std::max_element(poses.begin(), poses.end(), by_measure)->measure;
  std::vector<TriedPose> good;
  std::copy_if(poses.begin(), poses.end(), std::back_inserter(good),
               [&](const TriedPose& pose) { return pose.measure >= good_share * best; });
  if (std::any_of(good.begin(), good.end(), [](const TriedPose& pose) { return pose.tool_down; }))
    std::erase_if(good, [](const TriedPose& pose) { return !pose.tool_down; });
  constexpr double same = 1e-9;  // rad
  const TriedPose* chosen = &good.front();
  for (const TriedPose& pose : good)
    if (pose.distance < chosen->distance - same) chosen = &pose;
  ArmHome home{chosen->shown, {}};
  double measure = 0;
  if (arm.joints.size() <= 6)
    home.controlled =
        best_components(tip_motion(arm, joint_values(arm.joints, home.shown), length).J, measure);
  if (measure < regular_from) home.controlled.clear();
  return home;
}

}  // namespace counterflex::import
