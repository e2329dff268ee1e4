#include "counterflex/geometry/pose.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <random>

#include "counterflex/geometry/types.hpp"

using namespace counterflex;

namespace {

struct Poses {
  std::mt19937 random{11};
  std::uniform_real_distribution<double> uniform{-1, 1};
  Vector3 vector() { return {uniform(random), uniform(random), uniform(random)}; }
  Vector6 six() {
    Vector6 v;
    v << vector(), vector();
    return v;
  }
  Pose operator()() { return {exp_so3(1.7 * vector()), vector()}; }
};

double distance(const Pose& A, const Pose& B) {
  return (A.R - B.R).norm() + (A.p - B.p).norm();
}

}  // namespace

TEST_CASE("poses multiply as their matrices do and act on points") {
  Poses poses;
  for (int i = 0; i < 20; ++i) {
    const Pose X_AB = poses(), X_BC = poses(), X_CD = poses();
    const Vector3 p_C = poses.vector();
    CHECK((X_AB * X_BC * p_C - X_AB * (X_BC * p_C)).norm() < 1e-14);
    CHECK(distance((X_AB * X_BC) * X_CD, X_AB * (X_BC * X_CD)) < 1e-14);
    CHECK((X_AB * Vector3::Zero() - X_AB.p).norm() == 0);
  }
}

TEST_CASE("a pose times its inverse is the identity, from both sides") {
  Poses poses;
  for (int i = 0; i < 20; ++i) {
    const Pose X = poses();
    CHECK(distance(X * inverse(X), Pose{}) < 1e-14);
    CHECK(distance(inverse(X) * X, Pose{}) < 1e-14);
  }
}

TEST_CASE("a pose is its translation times its rotation") {
  const Pose X = Poses{}();
  CHECK(distance(translation(X.p) * rotation(X.R), X) < 1e-15);
}

TEST_CASE("moving undoes the difference and the difference undoes moving") {
  Poses poses;
  for (int i = 0; i < 50; ++i) {
    const Pose from = poses(), to = poses();
    CHECK(distance(moved(from, difference(to, from)), to) < 1e-13);
    const Vector6 step = poses.six();  // rotation below half a turn
    CHECK((difference(moved(from, step), from) - step).norm() < 1e-13);
  }
}

TEST_CASE("moving turns about the pose's own origin, in the axes outside") {
  const Pose X{exp_so3({0, 0, 90 * deg}), {1, 2, 3}};
  Vector6 step;
  step << 0.1, 0, 0, 90 * deg, 0, 0;
  const Pose Y = moved(X, step);
  CHECK((Y.p - Vector3(1.1, 2, 3)).norm() < 1e-15);
  CHECK((Y.R * Vector3::UnitX() - Vector3::UnitZ()).norm() < 1e-15);  // x was along y, turned about x to z
}

TEST_CASE("a wrench moved to another point gains the moment r x f") {
  Vector6 F_B;
  F_B << 215, -10, -25, 0, 0, 0;
  const Vector6 F_A = wrench_at(F_B, {0, 0, 0.1});
  Vector6 expected;
  expected << 215, -10, -25, 1, 21.5, 0;
  CHECK((F_A - expected).norm() < 1e-13);
}

TEST_CASE("a wrench's power does not depend on the point at which it is written") {
  Poses poses;
  for (int i = 0; i < 20; ++i) {
    const Vector6 F_B = poses.six(), twist_A = poses.six();
    const Vector3 p_AB = poses.vector();
    Vector6 twist_B = twist_A;
    twist_B.head<3>() += twist_A.tail<3>().cross(p_AB);
    CHECK(wrench_at(F_B, p_AB).dot(twist_A) == doctest::Approx(F_B.dot(twist_B)));
  }
}

TEST_CASE("wrenches moved there and back are unchanged") {
  Poses poses;
  const Vector6 F = poses.six();
  const Vector3 p = poses.vector();
  CHECK((wrench_at(wrench_at(F, p), -p) - F).norm() < 1e-15);
}
