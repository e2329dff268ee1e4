#include "counterflex/statics/arm_margins.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "counterflex/files/files.hpp"
#include "counterflex/geometry/pose.hpp"
#include "counterflex/geometry/types.hpp"
#include "statics/support/batch_support.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

/// The margin of the KR 270 of the tests at joint angles in degrees.
ArmMargin margin_at(const Model& model, const std::array<double, 6>& joints_deg) {
  Configuration configuration = model.home;
  Eigen::VectorXd rho(6);
  for (std::size_t i = 0; i < 6; ++i) rho[static_cast<Eigen::Index>(i)] = joints_deg[i] * deg;
  const NominalResult there = nominal_forward(model, model.home, rho);
  REQUIRE(there.status == Status::converged);
  const auto margin = arm_margin(model, there.configuration);
  REQUIRE(margin);
  return *margin;
}

std::string name_of(const ArmMargin& margin) {
  const std::string what = margin.what;
  return what.substr(0, what.find(':'));
}

}  // namespace

TEST_CASE("an arm is as far from a change of its wrist as axis 5 from zero") {
  const Model model = prepare(machine_of("serial6r_joints"));
  for (const double a5 : {0.4, -0.4, 3.0, 179.0}) {
    const ArmMargin margin = margin_at(model, {10, -70, 100, 40, a5, -30});
    CHECK(name_of(margin) == "wrist");
    CHECK(margin.angle == doctest::Approx(std::min(std::abs(a5), 180 - std::abs(a5)) * deg).epsilon(1e-9));
  }
}

TEST_CASE("an arm is as far from a change of its elbow as the wrist centre from the line of axes 2 and 3") {
  const Model model = prepare(machine_of("serial6r_joints"));
  const double straight = std::atan2(0.041, 1.2) / deg;  // axis 3 at which the forearm's offset is in line
  for (const double off : {0.7, -1.5}) {
    const ArmMargin margin = margin_at(model, {0, -40, -straight + off, 20, 60, 0});
    CHECK(name_of(margin) == "elbow");
    CHECK(margin.angle == doctest::Approx(std::abs(off) * deg).epsilon(1e-9));
  }
}

TEST_CASE("the wrist centre above axis 1 is a change of the shoulder") {
  const Model model = prepare(machine_of("serial6r_joints"));
  // Axis 2 is 0.35 m in front of axis 1: the arm leans back by that.
  const double forearm = std::hypot(1.2, 0.041), a3 = 90 - std::atan2(0.041, 1.2) / deg;
  const double back = std::asin(0.35 / std::hypot(1.15, forearm)) / deg;
  const double elbow = std::atan2(forearm, 1.15) / deg;
  const ArmMargin margin = margin_at(model, {0, -90 - back - elbow + 0.2, a3, 30, 50, 0});
  CHECK(name_of(margin) == "shoulder");
  CHECK(margin.angle < 0.5 * deg);
  CHECK(margin.angle > 0);
}

TEST_CASE("the margins of an arm with three parallel axes are zero where its Jacobian is singular") {
  const Model model = prepare(
      read_machine(read_file(COUNTERFLEX_SOURCE_DIR "/samples/robot-ur10/machine.toml"), "machine.toml"));
  // The wrist is in the plane of axes 1 and 2 at this angle of axis 2.
  const double along = 0.612 + 0.5723 * std::cos(70 * deg) - 0.1157 * std::sin(40 * deg),
               across = -0.5723 * std::sin(70 * deg) - 0.1157 * std::cos(40 * deg),
               shoulder = std::atan2(along, -across) / deg;
  struct Border {
    const char* name;
    std::array<double, 6> at, off;  // deg
  };
  for (const Border& border : {Border{"wrist", {10, -100, -110, -60, 0, 20}, {0, 0, 0, 0, 0.3, 0}},
                               Border{"wrist", {10, -100, -110, -60, 180, 20}, {0, 0, 0, 0, -0.3, 0}},
                               Border{"elbow", {10, -100, 0, -60, 70, 20}, {0, 0, 0.3, 0, 0, 0}},
                               Border{"shoulder", {10, shoulder, 70, -30, 70, 20}, {0, 0.3, 0, 0, 0, 0}}}) {
    CAPTURE(border.name);
    std::array<double, 6> near = border.at;
    for (std::size_t i = 0; i < 6; ++i) near[i] += border.off[i];
    const ArmMargin margin = margin_at(model, near);
    CHECK(name_of(margin) == border.name);
    CHECK(margin.angle > 0.1 * deg);
    CHECK(margin.angle < 0.3001 * deg);
    CHECK(margin_at(model, border.at).angle < 1e-6);
  }
}

TEST_CASE("an arm keeps its margins when a calibration moves its axes by a millimetre and a milliradian") {
  Machine arm =
      read_machine(read_file(COUNTERFLEX_SOURCE_DIR "/samples/robot-ur10/machine.toml"), "machine.toml");
  const Model catalogue = prepare(arm);
  Random random(3);
  for (Element& element : arm.chains[0].elements)
    if (auto* rigid = std::get_if<Rigid>(&element)) {
      rigid->X.p += random.vector(1e-3);
      rigid->X.R = exp_so3(random.vector(1e-3)) * rigid->X.R;
    }
  const Model calibrated = prepare(arm);
  for (const std::array<double, 6>& joints : {std::array<double, 6>{10, -100, -110, -60, 2, 20},
                                              std::array<double, 6>{10, -100, -3, -60, 70, 20}}) {
    const ArmMargin expected = margin_at(catalogue, joints), found = margin_at(calibrated, joints);
    CHECK(name_of(found) == name_of(expected));
    CHECK(std::abs(found.angle - expected.angle) < 0.4 * deg);
  }
}

TEST_CASE("machines that are no arms with a wrist have no such margin") {
  for (const char* name : {"orthoglide_case_b", "hexapod_free_joints"}) {
    const Model model = prepare(machine_of(name));
    CHECK(!arm_margin(model, model.home));
  }
}
