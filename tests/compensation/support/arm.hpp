#pragma once
/// A six-axis arm of the tests: products of homogeneous matrices, and joints that give way by the moment
/// about them. It shares nothing with the product's statics.
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>

#include "compensation/support/shop.hpp"

namespace counterflex::test {

using Matrix4 = Eigen::Matrix4d;

inline Matrix4 turn_about(int axis, double angle) {
  Matrix4 T = Matrix4::Identity();
  T.topLeftCorner<3, 3>() = Eigen::AngleAxisd(angle, Vector3::Unit(axis)).toRotationMatrix();
  return T;
}

inline Matrix4 shift(double x, double y, double z) {
  Matrix4 T = Matrix4::Identity();
  T.topRightCorner<3, 1>() = Vector3(x, y, z);
  return T;
}

/// The arm of tests/statics/data/serial6r_joints.toml, its tool turned by -90 degrees about y.
struct Arm {
  using Joints = Eigen::Matrix<double, 6, 1>;
  const std::array<int, 6> axes{2, 1, 1, 0, 1, 0};
  const Joints compliance = (Joints() << 0.25, 0.302, 0.406, 3.002, 3.303, 2.365).finished() * 1e-6;
  const Joints home = (Joints() << 0, -78, 108, 0, 60, 0).finished() * deg;
  bool perfect = false;

  /// Frames behind each joint, then the tip.
  std::array<Matrix4, 7> frames(const Joints& q) const {
    const double lean = perfect ? 0 : 0.02 * deg, offset = perfect ? 0 : 0.05 * deg;
    const std::array<Matrix4, 6> links{shift(0.350, 0, 0.675) * turn_about(1, offset),
                                       shift(1.150, 0, 0),
                                       shift(1.200, 0, -0.041),
                                       Matrix4::Identity(),
                                       Matrix4::Identity(),
                                       shift(0.215 + 0.250, 0, 0.120) * turn_about(1, -90 * deg)};
    std::array<Matrix4, 7> all;
    Matrix4 T = turn_about(1, lean);
    for (std::size_t i = 0; i < 6; ++i) {
      T = T * turn_about(axes[i], q[static_cast<Eigen::Index>(i)]);
      all[i] = T;
      T = T * links[i];
    }
    all[6] = T;
    return all;
  }

  /// The joints at which the perfect arm has that tip: Newton's method on its frames.
  Joints inverse(const Matrix4& wanted) const {
    const Arm rigid{.perfect = true};
    Joints q = home;
    for (int k = 0; k < 60; ++k) {
      const auto all = rigid.frames(q);
      Eigen::Matrix<double, 6, 1> miss;
      miss.head<3>() = wanted.topRightCorner<3, 1>() - all[6].topRightCorner<3, 1>();
      const Eigen::AngleAxisd turn(
          Matrix3(wanted.topLeftCorner<3, 3>() * all[6].topLeftCorner<3, 3>().transpose()));
      miss.tail<3>() = turn.angle() * turn.axis();
      if (miss.norm() < 1e-14) break;
      Eigen::Matrix<double, 6, 6> J;
      for (std::size_t i = 0; i < 6; ++i) {
        const Vector3 axis = all[i].topLeftCorner<3, 3>() * Vector3::Unit(axes[i]),
                      arm = all[6].topRightCorner<3, 1>() - all[i].topRightCorner<3, 1>();
        J.col(static_cast<Eigen::Index>(i)) << axis.cross(arm), axis;
      }
      Joints step = J.partialPivLu().solve(miss);
      if (step.norm() > 0.3) step *= 0.3 / step.norm();
      q += step;
    }
    return q;
  }

  /// Where the real arm has its tip when that pose is commanded, under the wrench `F` at the tip.
  Matrix4 tip(const Matrix4& commanded, const Vector6& F) const {
    const Joints q = inverse(commanded);
    Joints given = Joints::Zero();
    for (int k = 0; k < 100; ++k) {
      const auto all = frames(q + given);
      Joints next;
      for (std::size_t i = 0; i < 6; ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        const Vector3 axis = all[i].topLeftCorner<3, 3>() * Vector3::Unit(axes[i]),
                      arm = all[6].topRightCorner<3, 1>() - all[i].topRightCorner<3, 1>();
        next[row] = compliance[row] * axis.dot(F.tail<3>() + arm.cross(F.head<3>()));
      }
      if ((next - given).norm() < 1e-16) break;
      given = next;
    }
    return frames(q + given)[6];
  }
};

inline Matrix4 homogeneous(const Vector3& p, const Matrix3& R) {
  Matrix4 T = Matrix4::Identity();
  T.topLeftCorner<3, 3>() = R;
  T.topRightCorner<3, 1>() = p;
  return T;
}

inline Matrix3 rotation_of_words(const Vector3& abc_deg) {
  return (turn_about(2, abc_deg.z() * deg) * turn_about(1, abc_deg.y() * deg) *
          turn_about(0, abc_deg.x() * deg))
      .topLeftCorner<3, 3>();
}

inline double angle_between(const Matrix3& a, const Matrix3& b) {
  return Eigen::AngleAxisd(Matrix3(a * b.transpose())).angle();
}

/// The machine of `Arm` for the product.
inline std::string arm_text() {
  return replaced(read_file(robot), "xyz_mm = [250, 0, 120]",
                  "xyz_mm = [250, 0, 120]\nrpy_deg = [0, -90, 0]");
}

inline Machine arm_machine() {
  return read_machine(arm_text(), "arm.toml");
}

}  // namespace counterflex::test
