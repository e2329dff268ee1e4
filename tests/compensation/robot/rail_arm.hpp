#pragma once
/// A six-axis arm of the 300 kg class on a rail, by products of exponentials of twists: exp(S1 q1) ... exp(S7
/// q7) M. It shares nothing with the product's statics.
#include <fmt/format.h>

#include <Eigen/LU>
#include <array>
#include <string>

#include "compensation/support/arm.hpp"

namespace counterflex::test {

/// Errors of assembly: turns (deg, about the axes of M at zero) of the rail, the base and the upper arm, and
/// the errors of the zeros of the joints.
struct RailErrors {
  Vector3 rail_deg = Vector3::Zero(), base_deg = Vector3::Zero(), shoulder_deg = Vector3::Zero();
  std::array<double, 6> zeros_deg{};
};

class RailArm {
 public:
  using Joints = Eigen::Matrix<double, 6, 1>;

  RailArm(const RailErrors& errors, double rail) : errors_(errors), rail_(rail) {}

  /// The tip for joints in radians.
  Matrix4 forward(const Joints& q) const { return frames(q).tip; }

  /// The joints at which the arm without errors has that tip: Newton's method from home.
  Joints inverse(const Matrix4& wanted) const {
    const RailArm perfect({}, rail_);
    Joints q =
        (Joints() << std::atan2(wanted(1, 3), wanted(0, 3) - rail_) / deg, -80, 110, 0, 60, 0).finished() *
        deg;
    for (int k = 0; k < 200; ++k) {
      const Frames now = perfect.frames(q);
      Vector6 miss;  // turn, shift of the tip
      const Eigen::AngleAxisd turn(
          Matrix3(wanted.topLeftCorner<3, 3>() * now.tip.topLeftCorner<3, 3>().transpose()));
      miss << turn.angle() * turn.axis(), wanted.topRightCorner<3, 1>() - now.tip.topRightCorner<3, 1>();
      if (miss.norm() < 1e-14) break;
      Joints step = jacobian(now).partialPivLu().solve(miss);
      if (step.norm() > 0.2) step *= 0.2 / step.norm();
      q += step;
    }
    return q;
  }

  /// The tip of the arm with errors and joints that give way, when that pose is commanded. `F`: wrench at the
  /// tip.
  Matrix4 tip(const Matrix4& commanded, const Vector6& F) const {
    Joints q = inverse(commanded), given = Joints::Zero();
    for (std::size_t i = 0; i < 6; ++i) q[static_cast<Eigen::Index>(i)] += errors_.zeros_deg[i] * deg;
    Vector6 moment_and_force;
    moment_and_force << F.tail<3>(), F.head<3>();
    for (int k = 0; k < 100; ++k) {
      const Joints next =
          compliance.cwiseProduct(Joints(jacobian(frames(q + given)).transpose() * moment_and_force));
      const bool settled = (next - given).norm() < 1e-16;
      given = next;
      if (settled) break;
    }
    return forward(q + given);
  }

 private:
  using Twist = Vector6;  // angular part, then that of the point at the origin

  struct Frames {
    std::array<Twist, 6> axes;  // in M
    Matrix4 tip;
  };

  static Matrix4 hat(const Twist& S) {
    Matrix4 X = Matrix4::Zero();
    X << 0, -S[2], S[1], S[3], S[2], 0, -S[0], S[4], -S[1], S[0], 0, S[5], 0, 0, 0, 0;
    return X;
  }

  /// The exponential by its series, halved often enough.
  static Matrix4 exp(const Matrix4& X) {
    constexpr int halvings = 6;
    const Matrix4 small = X / (1 << halvings);
    Matrix4 sum = Matrix4::Identity(), term = Matrix4::Identity();
    for (int n = 1; n < 20; ++n) sum += term = term * small / n;
    for (int k = 0; k < halvings; ++k) sum = Matrix4(sum * sum);
    return sum;
  }

  static Twist revolute(const Vector3& axis, const Vector3& point) {
    Twist S;
    S << axis, point.cross(axis);
    return S;
  }

  static Twist transformed(const Matrix4& T, const Twist& S) {
    const Matrix4 X = T * hat(S) * T.inverse();
    Twist result;
    result << X(2, 1), X(0, 2), X(1, 0), X(0, 3), X(1, 3), X(2, 3);
    return result;
  }

  /// Turns about fixed axes through a point, about x first.
  static Matrix4 turns(const Vector3& rpy_deg, const Vector3& point) {
    Matrix4 T = Matrix4::Identity();
    for (const int axis : {2, 1, 0})
      T = T * exp(hat(revolute(Vector3::Unit(axis), point)) * (rpy_deg[axis] * deg));
    return T;
  }

  Frames frames(const Joints& q) const {
    const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY(), z = Vector3::UnitZ();
    const Vector3 shoulder(0.35, 0, 0.675), elbow(1.5, 0, 0.675), wrist(2.7, 0, 0.634);
    const std::array<Twist, 6> at_zero{revolute(z, Vector3::Zero()), revolute(y, shoulder),
                                       revolute(y, elbow),           revolute(x, wrist),
                                       revolute(y, wrist),           revolute(x, wrist)};
    Matrix4 M = Matrix4::Identity();
    M.topLeftCorner<3, 3>() << 0, 0, -1, 0, 1, 0, 1, 0, 0;  // z of the tool to the spindle, along -x
    M.topRightCorner<3, 1>() = wrist + Vector3(0.215 + 0.3, 0, 0);
    Twist along_rail;
    along_rail << Vector3::Zero(), x;
    Matrix4 T = turns(errors_.rail_deg, Vector3::Zero()) * exp(hat(along_rail) * rail_) *
                turns(errors_.base_deg, Vector3::Zero());
    Frames all;
    for (std::size_t i = 0; i < 6; ++i) {
      all.axes[i] = transformed(T, at_zero[i]);
      T = T * exp(hat(at_zero[i]) * q[static_cast<Eigen::Index>(i)]);
      if (i == 1) T = T * turns(errors_.shoulder_deg, shoulder);
    }
    all.tip = T * M;
    return all;
  }

  /// Turn and shift of the tip by each joint.
  static Eigen::Matrix<double, 6, 6> jacobian(const Frames& now) {
    Eigen::Matrix<double, 6, 6> J;
    const Vector3 tip = now.tip.topRightCorner<3, 1>();
    for (std::size_t i = 0; i < 6; ++i) {
      const Twist& S = now.axes[i];
      J.col(static_cast<Eigen::Index>(i)) << S.head<3>(), S.tail<3>() + S.head<3>().cross(tip);
    }
    return J;
  }

  const Joints compliance =
      (Joints() << 0.25, 0.302, 0.406, 3.002, 3.303, 2.365).finished() * 1e-6;  // rad/N m
  RailErrors errors_;
  double rail_;  // m
};

/// The same arm for the product, on a rail that the program commands as `axis`.
inline Machine rail_machine(const RailErrors& errors, const std::string& axis) {
  const auto turns = [](const char* name, const Vector3& rpy) {
    return fmt::format("errors.{} = {{ rpy_deg = [{}, {}, {}] }}\n", name, rpy.x(), rpy.y(), rpy.z());
  };
  std::string text = R"(format = "counterflex-machine 1"
controlled = ["x", "y", "z", "rx", "ry", "rz"]
[tool]
xyz_mm = [300, 0, 0]
rpy_deg = [0, -90, 0]
[[chain]]
name = "arm"
elements = [
  { error = "rail" },
  { actuator = "prismatic", axis = "x", program_axis = ")" +
                     axis + R"(", min_mm = -6000, max_mm = 6000 },
  { error = "base" },
)";
  struct Joint {
    char axis;
    const char *home, *compliance, *behind;
  };
  const std::array<Joint, 6> joints{
      {{'z', "0", "0.25e-6", "{ rigid = { xyz_mm = [350, 0, 675] } },"},
       {'y', "-80", "0.302e-6", "{ error = \"shoulder\" }, { rigid = { xyz_mm = [1150, 0, 0] } },"},
       {'y', "110", "0.406e-6", "{ rigid = { xyz_mm = [1200, 0, -41] } },"},
       {'x', "0", "3.002e-6", ""},
       {'y', "60", "3.303e-6", ""},
       {'x', "0", "2.365e-6", "{ rigid = { xyz_mm = [215, 0, 0] } },"}}};
  std::string of_zeros;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Joint& j = joints[i];
    text += fmt::format(
        "  {{ error = \"zero_{0}\" }},\n  {{ actuator = \"revolute\", axis = \"{1}\", home_deg = {2} }},\n"
        "  {{ compliance = \"revolute\", axis = \"{1}\", compliance_rad_per_Nm = {3} }},\n  {4}\n",
        i + 1, j.axis, j.home, j.compliance, j.behind);
    Vector3 zero = Vector3::Zero();
    zero[j.axis - 'x'] = errors.zeros_deg[i];
    of_zeros += turns(fmt::format("zero_{}", i + 1).c_str(), zero);
  }
  text += "]\n" + turns("rail", errors.rail_deg) + turns("base", errors.base_deg) +
          turns("shoulder", errors.shoulder_deg) + of_zeros;
  return read_machine(text, "rail.toml");
}

}  // namespace counterflex::test
