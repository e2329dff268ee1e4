#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "counterflex/geometry/pose.hpp"
#include "counterflex/geometry/types.hpp"

using namespace counterflex;

namespace {

std::vector<Vector3> directions(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Vector3> result = {Vector3::UnitX(), -Vector3::UnitY(), Vector3::UnitZ()};
  for (int i = 0; i < count; ++i)
    result.push_back(Vector3(normal(random), normal(random), normal(random)).normalized());
  return result;
}

/// The exponential by its power series, independent of the closed form. |phi| <= 4.
Matrix3 exp_by_series(const Vector3& phi) {
  const Matrix3 S = skew(phi);
  Matrix3 sum = Matrix3::Identity(), term = Matrix3::Identity();
  for (int n = 1; n < 60; ++n) {
    term = term * S / n;
    sum += term;
  }
  return sum;
}

/// J_l = sum S^n / (n + 1)!
Matrix3 left_jacobian_by_series(const Vector3& phi) {
  const Matrix3 S = skew(phi);
  Matrix3 sum = Matrix3::Identity(), term = Matrix3::Identity();
  for (int n = 1; n < 60; ++n) {
    term = term * S / (n + 1);
    sum += term;
  }
  return sum;
}

const std::vector<double> angles = {0,   1e-160, 1e-9, 1e-5, 1e-3, 0.1,  0.3,       0.5 - 1e-15,
                                    0.5, 0.51,   1,    2,    2.5,  3.14, pi - 1e-9, pi};

}  // namespace

TEST_CASE("the skew matrix is the cross product") {
  const Vector3 v(1, 2, 3), w(-4, 5, 0.5);
  CHECK((skew(v) * w - v.cross(w)).norm() < 1e-15);
  CHECK((skew(v) + skew(v).transpose()).norm() == 0);
}

TEST_CASE("the exponential is its power series and a rotation") {
  for (const Vector3& u : directions(20, 1))
    for (const double angle : angles) {
      CAPTURE(angle);
      const Matrix3 R = exp_so3(angle * u);
      CHECK((R - exp_by_series(angle * u)).norm() < 1e-14);
      CHECK((R * R.transpose() - Matrix3::Identity()).norm() < 1e-14);
    }
}

TEST_CASE("the logarithm undoes the exponential below half a turn") {
  for (const Vector3& u : directions(20, 2))
    for (const double angle : angles) {
      if (angle >= pi - 1e-6) continue;
      CAPTURE(angle);
      CHECK((log_so3(exp_so3(angle * u)) - angle * u).norm() < 2e-15 * (1 + angle));
      if (angle < 1e-4) CHECK((log_so3(exp_so3(angle * u)) - angle * u).norm() <= 1e-14 * angle);
    }
}

TEST_CASE("at half a turn and just beside it the logarithm is one of the two vectors of that rotation") {
  for (const Vector3& u : directions(20, 3))
    for (const double angle : {pi - 1e-6, pi - 1e-9, pi - 1e-13, pi, pi + 1e-9, pi + 1e-6}) {
      CAPTURE(angle);
      const Matrix3 R = exp_so3(angle * u);
      const Vector3 phi = log_so3(R);
      CHECK(phi.norm() <= pi + 1e-15);
      CHECK((exp_so3(phi) - R).norm() < 1e-14);
      CHECK(std::abs(std::abs(phi.normalized().dot(u)) - 1) < 1e-14);
    }
}

TEST_CASE("the left Jacobian is its power series") {
  for (const Vector3& u : directions(10, 4))
    for (const double angle : angles) {
      CAPTURE(angle);
      CHECK((left_jacobian(angle * u) - left_jacobian_by_series(angle * u)).norm() < 1e-14);
    }
}

TEST_CASE("the left Jacobian turns rates of the rotation vector into angular velocity") {
  const double h = 1e-5;
  for (const Vector3& u : directions(10, 5))
    for (const double angle : {0.0, 0.2, 0.6, 1.7, 3.0, pi, 4.0}) {
      CAPTURE(angle);
      const Vector3 phi = angle * u;
      for (int k = 0; k < 3; ++k) {
        const Vector3 step = h * Vector3::Unit(k);
        // Exp(phi + h) Exp(phi - h)' = Exp(2 h J_l e_k) to third order
        const Vector3 w = log_so3(exp_so3(phi + step) * exp_so3(phi - step).transpose()) / (2 * h);
        CHECK((left_jacobian(phi).col(k) - w).norm() < 1e-9);
      }
    }
}

TEST_CASE("the inverse of the left Jacobian is its inverse") {
  for (const Vector3& u : directions(10, 6))
    for (const double angle : {0.0, 1e-9, 1e-3, 0.49, 0.5, 1.0, pi, 5.0, 6.0}) {
      CAPTURE(angle);
      const Vector3 phi = angle * u;
      CHECK((left_jacobian(phi) * left_jacobian_inverse(phi) - Matrix3::Identity()).norm() < 1e-12);
    }
}

TEST_CASE("the derivatives of the left Jacobian match central differences") {
  const double h = 1e-5;
  for (const Vector3& u : directions(10, 7))
    for (const double angle : {0.0, 1e-3, 0.3, 0.5, 0.7, 1.7, 3.0, pi, 4.0}) {
      CAPTURE(angle);
      const auto d = left_jacobian_derivatives(angle * u);
      for (int k = 0; k < 3; ++k) {
        const Vector3 step = h * Vector3::Unit(k);
        const Matrix3 expected =
            (left_jacobian(angle * u + step) - left_jacobian(angle * u - step)) / (2 * h);
        CHECK((d[k] - expected).norm() < 1e-9);
      }
    }
}

TEST_CASE("series and closed form agree where one takes over from the other") {
  for (const Vector3& u : directions(10, 8)) {
    const Vector3 below = std::nextafter(0.5, 0.0) * Vector3::UnitX(), above = 0.5 * Vector3::UnitX();
    REQUIRE(below.norm() < 0.5);
    REQUIRE(above.norm() >= 0.5);
    CHECK((exp_so3(below) - exp_so3(above)).norm() < 1e-15);
    const Vector3 nearly = (0.5 - 1e-15) * u, over = (0.5 + 1e-15) * u;
    CHECK((left_jacobian(nearly) - left_jacobian(over)).norm() < 1e-14);
    CHECK((left_jacobian_inverse(nearly) - left_jacobian_inverse(over)).norm() < 1e-13);
    for (int k = 0; k < 3; ++k)
      CHECK((left_jacobian_derivatives(nearly)[k] - left_jacobian_derivatives(over)[k]).norm() < 1e-13);
  }
}

TEST_CASE("mixed derivatives obey the Maurer-Cartan equation d_k w_j - d_j w_k = w_k x w_j") {
  for (const Vector3& u : directions(10, 9))
    for (const double angle : angles) {
      CAPTURE(angle);
      const Matrix3 J = left_jacobian(angle * u);
      const auto d = left_jacobian_derivatives(angle * u);
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k)
          CHECK((d[k].col(j) - d[j].col(k) - J.col(k).cross(J.col(j))).norm() < 1e-13);
    }
}

TEST_CASE("roll, pitch and yaw turn about fixed axes, roll first") {
  const Matrix3 R = from_rpy({90 * deg, 0, 90 * deg});
  CHECK((R * Vector3::UnitY() - Vector3::UnitZ()).norm() < 1e-15);  // roll takes y to z, yaw leaves it
  CHECK((R * Vector3::UnitX() - Vector3::UnitY()).norm() < 1e-15);
  const Matrix3 P = from_rpy({0, 30 * deg, 0});
  CHECK(P(0, 2) == doctest::Approx(0.5));
  CHECK(P(2, 0) == doctest::Approx(-0.5));
  const Vector3 rpy(0.3, -0.4, 2.0);
  const Matrix3 product = exp_so3({0, 0, 2.0}) * exp_so3({0, -0.4, 0}) * exp_so3({0.3, 0, 0});
  CHECK((from_rpy(rpy) - product).norm() < 1e-15);
}

TEST_CASE("roll, pitch and yaw are found again") {
  std::mt19937 random(10);
  std::uniform_real_distribution<double> full(-pi, pi), half(-0.499 * pi, 0.499 * pi);
  for (int i = 0; i < 200; ++i) {
    const Vector3 rpy(full(random), half(random), full(random));
    CAPTURE(rpy.transpose());
    CHECK((to_rpy(from_rpy(rpy)) - rpy).norm() < 1e-12);
  }
}

TEST_CASE("at and near the poles the angles still give the rotation, and at the poles roll is 0") {
  for (const double sign : {-1.0, 1.0}) {
    for (const double off : {1e-13, 1e-11, 1e-9, 1e-7, 1e-5, 1e-3}) {
      CAPTURE(off);
      const Matrix3 R = from_rpy({0.7, sign * (pi / 2 - off), -1.2});
      CHECK((from_rpy(to_rpy(R)) - R).norm() < 1e-12);
    }
    const Vector3 at = to_rpy(from_rpy({0.7, sign * pi / 2, -1.2}));
    CHECK(at.x() == 0);
    CHECK(at.y() == doctest::Approx(sign * pi / 2));
  }
}

TEST_CASE("a quaternion is scalar first, normalised, and the same rotation with its sign turned") {
  const Eigen::Vector4d q(std::cos(0.35), 0, std::sin(0.35), 0);
  CHECK((from_quaternion(q) - exp_so3({0, 0.7, 0})).norm() < 1e-15);
  CHECK((from_quaternion(-3 * q) - exp_so3({0, 0.7, 0})).norm() < 1e-15);
}

TEST_CASE("the rotation between two orientations leads from one to the other, for any angle") {
  const Matrix3 R_from = exp_by_series({0.3, -1.2, 0.7});
  for (const Vector3& u : directions(20, 11))
    for (const double angle : {0.0, 1e-12, 1e-7, 1e-3, 0.00999, 0.0101, 0.1, 1.0, 3.0, pi - 1e-6}) {
      CAPTURE(angle);
      const Vector3 phi = rotation_between(exp_by_series(angle * u) * R_from, R_from);
      CHECK((phi - angle * u).norm() < 2e-15 + 1e-15 * angle);
    }
}
