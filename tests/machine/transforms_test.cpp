#include <doctest/doctest.h>

#include "counterflex/geometry/types.hpp"
#include "machine_texts.hpp"

using namespace counterflex;

namespace {

Pose rigid(const std::string& transform) {
  return read_part<Rigid>("{ rigid = { " + transform + " } }").X;
}

double distance(const Pose& a, const Pose& b) {
  return (a.R - b.R).norm() + (a.p - b.p).norm();
}

}  // namespace

TEST_CASE("an empty transform is identity") {
  CHECK(distance(rigid(""), Pose{}) == 0);
}

TEST_CASE("xyz_mm is in millimetres, integers or decimals") {
  CHECK((rigid("xyz_mm = [1, -2.5, 3e1]").p - Vector3(1e-3, -2.5e-3, 30e-3)).norm() < 1e-17);
}

TEST_CASE("rpy_deg turns about fixed axes, roll first") {
  const Matrix3 R = rigid("rpy_deg = [90, 0, 90]").R;
  CHECK((R * Vector3::UnitY() - Vector3::UnitZ()).norm() < 1e-15);
  CHECK((R * Vector3::UnitX() - Vector3::UnitY()).norm() < 1e-15);
}

TEST_CASE("rotvec_deg turns about its direction by its length") {
  const double turn = 120 / std::sqrt(3.0);
  const Matrix3 R = rigid("rotvec_deg = [69.28203230275509, 69.28203230275509, 69.28203230275509]").R;
  CHECK(turn == doctest::Approx(69.28203230275509));
  CHECK((R * Vector3::UnitX() - Vector3::UnitY()).norm() < 1e-14);
}

TEST_CASE("a quaternion is normalised on reading, to an exact rotation") {
  const Matrix3 R = rigid("quat_wxyz = [0.7071068, 0, 0, 0.7071068]").R;
  CHECK((R * R.transpose() - Matrix3::Identity()).norm() < 1e-15);
  CHECK((R * Vector3::UnitX() - Vector3::UnitY()).norm() < 1e-15);
}

TEST_CASE("xyz_mm translates first and xyz_after_mm rotates first") {
  CHECK((rigid("xyz_mm = [10, 0, 0], rpy_deg = [0, 0, 90]").p - Vector3(0.01, 0, 0)).norm() < 1e-17);
  CHECK((rigid("xyz_after_mm = [10, 0, 0], rpy_deg = [0, 0, 90]").p - Vector3(0, 0.01, 0)).norm() < 1e-17);
}
