#include "counterflex/report/kinematics.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "counterflex/geometry/turn.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "report/text/assumptions.hpp"

using namespace counterflex;

namespace {

Model arm() {
  return prepare(load_machine(COUNTERFLEX_SOURCE_DIR "/tests/statics/data/serial6r_joints.toml"));
}

Eigen::VectorXd degrees(std::initializer_list<double> values) {
  Eigen::VectorXd list(static_cast<Eigen::Index>(values.size()));
  Eigen::Index i = 0;
  for (const double value : values) list[i++] = value * deg;
  return list;
}

}  // namespace

TEST_CASE("the tip of joint values, and the joint values of that tip") {
  const Model model = arm();
  const Eigen::VectorXd joints = degrees({12, -70, 95, 20, 50, -35});
  const KinematicPlace there = place_at_values(model, joints);
  REQUIRE(there.status == Status::converged);
  const KinematicPlace back = place_at_tip(model, there.X_MT);
  REQUIRE(back.status == Status::converged);
  CHECK((back.shown - joints).norm() < 1e-8);
  CHECK((back.X_MT.p - there.X_MT.p).norm() < 1e-10);
  REQUIRE(there.margins);
  CHECK((*there.margins)[0].angle == doctest::Approx(50 * deg));  // axis A5
}

TEST_CASE("a stretched arm has its tip at the sum of the lengths") {
  const KinematicPlace place = place_at_values(arm(), degrees({0, 0, 0, 0, 0, 0}));
  CHECK((place.X_MT.p - Vector3(350 + 1150 + 1200 + 215 + 250, 0, 675 - 41 + 120) * mm).norm() < 1e-12);
}

TEST_CASE("joint values of a tip are those nearest to home") {
  const Model model = arm();
  const Matrix3 R = Eigen::AngleAxisd(90 * deg, Vector3::UnitY()).toRotationMatrix();
  const KinematicPlace place = place_at_tip(model, {R, Vector3(1750, -0.001, 640) * mm});
  REQUIRE(place.status == Status::converged);
  CHECK((place.shown - actuator_values(model.mechanism, model.home)).cwiseAbs().maxCoeff() < 180 * deg);
  CHECK((place_at_values(model, place.shown).X_MT.p - place.X_MT.p).norm() < 1e-9);
}

TEST_CASE("joint values are as the control shows them") {
  Machine machine = load_machine(COUNTERFLEX_SOURCE_DIR "/tests/statics/data/serial6r_joints.toml");
  const Pose X = place_at_values(prepare(machine), degrees({0, -80, 100, 0, 60, 0})).X_MT;
  int number = 0;
  for (Element& element : machine.chains[0].elements)
    if (auto* actuator = std::get_if<Actuator>(&element); actuator != nullptr && ++number == 3)
      actuator->shown = {-1, 10 * deg, {{1, -1}}};
  const Model shown = prepare(machine);
  const KinematicPlace place = place_at_tip(shown, X);
  CHECK(place.shown[2] / deg == doctest::Approx(-100 + 10 + 80));
  CHECK((place_at_values(shown, place.shown).X_MT.p - X.p).norm() < 1e-10);
}

TEST_CASE("the text has the orientation in the numbers of each control") {
  KinematicPlace place{Status::converged, "", {}, degrees({30, 0}), {}};
  place.X_MT = {
      (Eigen::AngleAxisd(30 * deg, Vector3::UnitZ()) * Eigen::AngleAxisd(20 * deg, Vector3::UnitY()) *
       Eigen::AngleAxisd(10 * deg, Vector3::UnitX()))
          .toRotationMatrix(),
      Vector3(1, 2, 3)};
  const KinematicsReport report{
      "1",
      "robot",
      "",
      {{-60 * deg, 70 * deg, JointKind::revolute, "axis A1"}, {-1, 2, JointKind::prismatic, "axis X"}},
      {place}};
  const std::string text = to_text(report);
  CAPTURE(text);
  CHECK(text.find("tip x y z        1000.0000, 2000.0000, 3000.0000 mm\n") != std::string::npos);
  CHECK(text.find("KUKA             A B C: 30.0000, 20.0000, 10.0000 deg\n") != std::string::npos);
  CHECK(text.find("FANUC, Yaskawa   W P R: 10.0000, 20.0000, 30.0000 deg\n") != std::string::npos);
  const Eigen::Quaterniond q(place.X_MT.R);
  const auto number = [](double value) {
    std::string digits = std::to_string(value);
    return digits.substr(0, digits.find('.') + 5);
  };
  CHECK(text.find("ABB              q1 to q4: " + number(q.w())) != std::string::npos);
  const Vector3 phi = log_so3(place.X_MT.R);
  CHECK(text.find("UR               rx ry rz: " + number(phi.x())) != std::string::npos);
  CHECK(text.find("axis A1              30.0000 deg margin      40.0 deg, travel -60 to 70 deg\n") !=
        std::string::npos);
  CHECK(to_json(report).find("\"margin\": 40.0") != std::string::npos);
}

TEST_CASE("of two triples of angles the text has the one whose middle angle is within 90 degrees") {
  struct Row {
    double x, y, z;  // deg, about fixed axes
    const char* shown;
  };
  for (const Row& row : {Row{12, -174, 78, "A B C: -102.0000, -6.0000, -168.0000 deg"},
                         Row{-168, -6, -102, "A B C: -102.0000, -6.0000, -168.0000 deg"},
                         Row{0, 90, 30, "A B C: 30.0000, 90.0000, 0.0000 deg"},
                         Row{0, -90, 30, "A B C: 30.0000, -90.0000, 0.0000 deg"},
                         Row{170, 80, -170, "A B C: -170.0000, 80.0000, 170.0000 deg"}}) {
    KinematicPlace place{Status::converged, "", {}, degrees({0}), {}};
    place.X_MT = {from_rpy(Vector3(row.x, row.y, row.z) * deg), Vector3::Zero()};
    const std::string text =
        to_text(KinematicsReport{"1", "robot", "", {{-pi, pi, JointKind::revolute, "axis A1"}}, {place}});
    CAPTURE(text);
    CHECK(text.find(row.shown) != std::string::npos);
  }
}

TEST_CASE("a place that is not reached has a status and no numbers") {
  const KinematicPlace place = place_at_tip(arm(), translation(Vector3(9, 0, 0)));
  CHECK(place.status != Status::converged);
  CHECK(!place.why.empty());
  const std::string text = to_text(KinematicsReport{"1", "robot", "", {}, {place}});
  CHECK(text.find("KUKA") == std::string::npos);
  CHECK(text.find(place.why) != std::string::npos);
}

TEST_CASE("the report has the lengths with which the control computes") {
  Machine machine = load_machine(COUNTERFLEX_SOURCE_DIR "/tests/statics/data/serial6r_joints.toml");
  const auto last = [&] { return not_modelled(machine).back(); };
  CHECK(last() == "the control's own corrections: absolute accuracy, payload data");
  machine.kinematics = ControlKinematics::factory;
  CHECK(last().find("calibrated lengths (kinematics = \"factory\")") != std::string::npos);
  machine.kinematics = ControlKinematics::catalogue;
  CHECK(last().find("catalogue lengths (kinematics = \"catalogue\")") != std::string::npos);
}
