#include <Eigen/Geometry>
#include <cmath>

#include "counterflex/geometry/pose.hpp"

namespace counterflex {
namespace {

// The coefficients of Exp and its derivatives as functions of t = |phi|, with their series where the closed
// form would lose digits:  a = sin t / t,  b = (1 - cos t) / t^2,  c = (t - sin t) / t^3, and db = b'/t, dc =
// c'/t.
struct Coefficients {
  double a, b, c, db, dc;
};

Coefficients coefficients(double t) {
  const double t2 = t * t;
  if (t < 0.5) {
    // Taylor series in t^2; at t = 0.5 the first omitted term is below 1e-17 relative.
    const auto series = [t2](double first, double ratio_start, double step) {
      double sum = 0, term = first;
      for (double n = ratio_start, k = 0; k < 9; ++k, n += step) {
        sum += term;
        term *= -t2 / (n * (n + 1));
      }
      return sum;
    };
    const auto slope = [t2](double first, double n) {  // d/d(t^2) of the series above, times 2
      double sum = 0, term = first;
      for (double k = 1; k < 9; ++k, n += 2) {
        term *= -1 / (n * (n + 1));
        sum += 2 * k * term;
        term *= t2;
      }
      return sum;
    };
    return {series(1.0, 2, 2), series(0.5, 3, 2), series(1.0 / 6, 4, 2), slope(0.5, 3), slope(1.0 / 6, 4)};
  }
  const double s = std::sin(t), co = std::cos(t);
  const double a = s / t, b = (1 - co) / t2, c = (t - s) / (t2 * t);
  return {a, b, c, (a - 2 * b) / t2, ((1 - co) / t2 - 3 * c) / t2};
}

}  // namespace

Matrix3 skew(const Vector3& v) {
  Matrix3 S;
  S << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return S;
}

Matrix3 exp_so3(const Vector3& phi) {
  const auto k = coefficients(phi.norm());
  const Matrix3 S = skew(phi);
  return Matrix3::Identity() + k.a * S + k.b * S * S;
}

Vector3 log_so3(const Matrix3& R) {
  // The quaternion is well conditioned at every angle: phi = 2 atan2(|v|, w) v / |v|.
  Eigen::Quaterniond q(R);
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double n = q.vec().norm();
  if (n < 1e-12) return 2.0 / q.w() * q.vec();
  return 2 * std::atan2(n, q.w()) / n * q.vec();
}

Vector3 rotation_between(const Matrix3& R_to, const Matrix3& R_from) {
  // R_to R_from' - R_from R_to' = 2 sin t [a]x for the rotation by t about a: the vector of it is the sum of
  // cross products of columns. t = (1 + s^2/6 + 3 s^4/40 + 5 s^6/112 + ...) s, s = sin t; the next term is
  // below 1e-17.
  const Vector3 v = 0.5 * (R_from.col(0).cross(R_to.col(0)) + R_from.col(1).cross(R_to.col(1)) +
                           R_from.col(2).cross(R_to.col(2)));
  const double s2 = v.squaredNorm(), trace = R_from.cwiseProduct(R_to).sum();
  if (s2 < 1e-4 && trace > 0) return (1 + s2 * (1.0 / 6 + s2 * (3.0 / 40 + s2 * (5.0 / 112)))) * v;
  return log_so3(R_to * R_from.transpose());
}

Matrix3 left_jacobian(const Vector3& phi) {
  const auto k = coefficients(phi.norm());
  const Matrix3 S = skew(phi);
  return Matrix3::Identity() + k.b * S + k.c * S * S;
}

Matrix3 left_jacobian_inverse(const Vector3& phi) {
  const auto k = coefficients(phi.norm());
  const Matrix3 S = skew(phi);
  // (1 - a / (2 b)) / t^2 = (2 b - a) / (2 b t^2) = -db / (2 b)
  return Matrix3::Identity() - 0.5 * S - k.db / (2 * k.b) * S * S;
}

std::array<Matrix3, 3> left_jacobian_derivatives(const Vector3& phi) {
  const auto k = coefficients(phi.norm());
  const Matrix3 S = skew(phi), S2 = S * S;
  std::array<Matrix3, 3> derivatives;
  for (int i = 0; i < 3; ++i) {
    const Matrix3 E = skew(Vector3::Unit(i));
    derivatives[i] = k.db * phi[i] * S + k.b * E + k.dc * phi[i] * S2 + k.c * (E * S + S * E);
  }
  return derivatives;
}

Matrix3 from_rpy(const Vector3& rpy) {
  return (Eigen::AngleAxisd(rpy.z(), Vector3::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Vector3::UnitY()) *
          Eigen::AngleAxisd(rpy.x(), Vector3::UnitX()))
      .toRotationMatrix();
}

Vector3 to_rpy(const Matrix3& R) {
  const double cos_pitch = std::hypot(R(0, 0), R(1, 0));
  const double pitch = std::atan2(-R(2, 0), cos_pitch);
  if (cos_pitch < 1e-12) return {0, pitch, std::atan2(-R(0, 1), R(1, 1))};
  // Roll is what remains after yaw has been taken out: near the poles both are ill conditioned, and only this
  // keeps their sum accurate.
  const double yaw = std::atan2(R(1, 0), R(0, 0)), s = std::sin(yaw), c = std::cos(yaw);
  return {std::atan2(s * R(0, 2) - c * R(1, 2), c * R(1, 1) - s * R(0, 1)), pitch, yaw};
}

Matrix3 from_quaternion(const Eigen::Vector4d& wxyz) {
  return Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).normalized().toRotationMatrix();
}

}  // namespace counterflex
