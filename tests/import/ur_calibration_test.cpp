#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "counterflex/import/import.hpp"
#include "counterflex/machine/parameters.hpp"
#include "counterflex/statics/nominal.hpp"
#include "import/arm_poses.hpp"

namespace counterflex::import_ur_calibration_test {
namespace {

constexpr std::array<const char*, 6> links = {"shoulder", "upper_arm", "forearm",
                                              "wrist_1",  "wrist_2",   "wrist_3"};

/// x, y, z (m), roll, pitch, yaw (rad) of the six links.
using Calibration = std::array<std::array<double, 6>, 6>;

std::string yaml_of(const Calibration& calibration) {
  std::string text = "kinematics:\n";
  for (std::size_t i = 0; i < 6; ++i) {
    char block[400];
    const auto& v = calibration[i];
    std::snprintf(block, sizeof block,
                  "  %s:\n    x: %.17g\n    y: %.17g\n    z: %.17g\n    roll: %.17g\n    pitch: %.17g\n    "
                  "yaw: %.17g\n",
                  links[i], v[0], v[1], v[2], v[3], v[4], v[5]);
    text += block;
  }
  return text + "  hash: calib_12345\n";
}

/// What the driver's tool writes of a robot without deviations: UR's published lengths of the UR10 (d1 127.3,
/// a2 -612, a3 -572.3, d4 163.941, d5 115.7, d6 92.2 mm).
constexpr Calibration nominal = {{{0, 0, 0.1273, 0, 0, 0},
                                  {0, 0, 0, pi / 2, 0, 0},
                                  {-0.612, 0, 0, 0, 0, 0},
                                  {-0.5723, 0, 0.163941, 0, 0, 0},
                                  {0, -0.1157, 0, pi / 2, 0, 0},
                                  {0, 0.0922, 0, pi / 2, pi, pi}}};

/// Deviations of the usual size, and the large angles that the tool writes.
constexpr Calibration calibrated = {{{0, 0, 0.12781, -0.0, 0, -1.5e-5},
                                     {8.3e-5, 0, 0, 1.5702793, 0, 9.4e-5},
                                     {-0.6123, 0, 0, 3.1408807, -3.1397252, -3.1415677},
                                     {-0.57189, 7e-4, 0.16414, 3.1351985, -3.1400954, 3.1415186},
                                     {3.7e-5, -0.11574, 1.8e-4, 1.5689051, 0, -1.3e-5},
                                     {1.5e-4, 0.09221, 1.3e-4, 1.572329, 3.1415926535897931, -3.1415868}}};

/// UR's published formula: standard Denavit-Hartenberg with alpha = (90, 0, 0, 90, -90, 0) degrees.
Pose published_pose(const std::vector<double>& q) {
  constexpr std::array<double, 6> a = {0, -0.612, -0.5723, 0, 0, 0},
                                  d = {0.1273, 0, 0, 0.163941, 0.1157, 0.0922},
                                  alpha = {pi / 2, 0, 0, pi / 2, -pi / 2, 0};
  Pose X;
  for (std::size_t i = 0; i < 6; ++i) {
    const double ct = std::cos(q[i]), st = std::sin(q[i]), ca = std::cos(alpha[i]), sa = std::sin(alpha[i]);
    Pose link;
    link.R << ct, -st * ca, st * sa, st, ct * ca, -ct * sa, 0, sa, ca;
    link.p << a[i] * ct, a[i] * st, d[i];
    X = X * link;
  }
  return X;
}

/// Rz(angle), and R = Rz(yaw) Ry(pitch) Rx(roll), written out.
Matrix3 about_z(double angle) {
  Matrix3 R;
  R << std::cos(angle), -std::sin(angle), 0, std::sin(angle), std::cos(angle), 0, 0, 0, 1;
  return R;
}

Pose calibrated_pose(const std::vector<double>& q) {
  Pose X;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto& v = calibrated[i];
    Matrix3 roll, pitch;
    roll << 1, 0, 0, 0, std::cos(v[3]), -std::sin(v[3]), 0, std::sin(v[3]), std::cos(v[3]);
    pitch << std::cos(v[4]), 0, std::sin(v[4]), 0, 1, 0, -std::sin(v[4]), 0, std::cos(v[4]);
    X.p += X.R * Vector3(v[0], v[1], v[2]);
    X.R = X.R * about_z(v[5]) * pitch * roll * about_z(q[i]);
  }
  return X;
}

std::string message_of(const std::string& text) {
  return diagnostic([&] { import_ur_calibration(text, "my.yaml"); });
}

}  // namespace

TEST_CASE("the calibration of a UR without deviations has the poses of UR's published formula") {
  check_poses(import_ur_calibration(yaml_of(nominal), "my.yaml"), published_pose);
}

TEST_CASE("a calibrated UR has the poses of the product of the file's transforms") {
  check_poses(import_ur_calibration(yaml_of(calibrated), "my.yaml"), calibrated_pose);
}

TEST_CASE("the control of a calibrated UR computes with the lengths of the file") {
  const Machine machine = read_machine(import_ur_calibration(yaml_of(calibrated), "my.yaml"), "m.toml");
  CHECK(machine.kinematics == ControlKinematics::factory);
  CHECK(machine.control.dialect == "ur");
  CHECK(machine.name == "Universal Robots arm calib_12345");
  CHECK(controls_pose(machine));
  const Model model = prepare(machine);
  CHECK(model.home_status == Status::converged);
  CHECK(actuator_jacobian(model, model.home).condition < 100);
  CHECK(number_sources(machine).prior == 42);
}

TEST_CASE("bad calibrations are refused at their place") {
  const std::string good = yaml_of(nominal);
  CHECK(message_of("") ==
        "my.yaml:1:1: error: the file has no map kinematics; give the calibration that ur_calibration of the "
        "ROS driver has written");
  CHECK(message_of("kinematics: [1, 2\n").starts_with("my.yaml:2:1: error: not YAML: "));
  CHECK(message_of(replaced(good, "upper_arm", "uper_arm")) ==
        "my.yaml:9:3: error: unknown key 'uper_arm' in kinematics; did you mean upper_arm?; allowed: "
        "shoulder, upper_arm, "
        "forearm, wrist_1, wrist_2, wrist_3, hash");
  CHECK(message_of("kinematics:\n  shoulder: {x: 0, y: 0, z: 0.1, roll: 0, pitch: 0, yaw: 0}\n") ==
        "my.yaml:2:3: error: kinematics lacks the link upper_arm; an arm has shoulder, upper_arm, forearm, "
        "wrist_1, wrist_2, "
        "wrist_3");
  CHECK(message_of(replaced(good, "    pitch: 0\n", "")) ==
        "my.yaml:3:5: error: shoulder lacks pitch; a link has x, y, z (m) and roll, pitch, yaw (rad)");
  CHECK(message_of(replaced(good, "z: 0.1273", "z: .nan"))
            .starts_with("my.yaml:5:8: error: shoulder.z is '.nan'; it must be a finite number"));
  CHECK(message_of(replaced(good, "    y: 0\n", "    y: 0\n    y: 1\n")) ==
        "my.yaml:5:5: error: shoulder has the key 'y' twice");
  CHECK(message_of(replaced(good, "x: -0.61199999999999999", "x: -612")) ==
        "my.yaml:17:5: error: forearm is 612 m away from the link before; lengths of a calibration file are "
        "in m, at most 5");
  CHECK(message_of(replaced(good, "    roll: 0\n", "    roll: 89.97\n")) ==
        "my.yaml:6:11: error: shoulder.roll is 89.97; angles of a calibration file are in rad, at most a "
        "turn (6.2832)");
}

}  // namespace counterflex::import_ur_calibration_test
