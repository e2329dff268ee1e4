#include <doctest/doctest.h>

#include <cmath>

#include "forces/sample_cut.hpp"
#include "forces/sample_path.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// A drill of 10 mm and two edges in 42CrMo4: kc1.1 = 1675 N/mm2, mc = 0.24.
CuttingModel drill() {
  CuttingModel model;
  model.mill = {10 * mm, 2, 0, 0, 118 * deg};
  model.coefficients.K_tc = 1675 * N_per_mm2 * std::pow(mm, 0.24);
  model.coefficients.m_c = 0.24;
  return model;
}

constexpr double drill_feed = 0.2 * mm * 1000 / 60;  // 0.2 mm a revolution at 1000/min

}  // namespace

TEST_CASE("the torque and thrust of a drill equal those computed by hand") {
  const CutForce force = cutting_force(drill(), drill_feed, 1000, -1);
  REQUIRE(force.why.empty());
  CHECK(force.feed_per_tooth == doctest::Approx(0.1 * mm));
  // h = 0.1 sin 59 deg, kc = 1675 h^-0.24, A = 10 x 0.2 / 4 mm2 an edge, two edges
  const double h_mm = 0.1 * std::sin(59 * deg), F_v = 2 * 1675 * std::pow(h_mm, -0.24) * 10 * 0.2 / 4;
  CHECK(F_v == doctest::Approx(3020.50).epsilon(1e-4));
  CHECK(force.F[5] == doctest::Approx(F_v * 2.5 * mm).epsilon(1e-12));
  CHECK(force.F[2] == doctest::Approx(0.9 * F_v).epsilon(1e-12));
  CHECK(force.chip_torque == doctest::Approx(force.F[5]));
  for (const int i : {0, 1, 3, 4}) CHECK(force.F[i] == 0);
}

TEST_CASE("the usual share of the thrust is that of the catalogue's formulas of thrust and torque") {
  for (const double f : {0.1, 0.2, 0.3, 0.4}) {
    for (const double D : {4.0, 10.0, 20.0}) {
      const double K = 2.41;  // of SCM440, 940 N/mm2: it cancels
      const double thrust = 570 * K * D * std::pow(f, 0.85), torque = K * D * D * (0.630 + 16.84 * f) / 100;
      CHECK(thrust / (4 * torque / (D * mm)) == doctest::Approx(usual_thrust_share).epsilon(0.035));
    }
  }
}

TEST_CASE("a sharper point has thinner chips and more force") {
  CuttingModel sharp = drill();
  sharp.mill.point_angle = 90 * deg;
  const double ratio =
      cutting_force(sharp, drill_feed, 1000, -1).F[2] / cutting_force(drill(), drill_feed, 1000, -1).F[2];
  CHECK(ratio == doctest::Approx(std::pow(std::sin(45 * deg) / std::sin(59 * deg), -0.24)));
}

TEST_CASE("a drill has no force sideways and in its retract, and needs feed and speed") {
  CHECK(cutting_force(drill(), drill_feed, 1000, 0).why ==
        "the cutter of its section only drills, and the feed is not along the tool axis");
  CHECK(cutting_force(drill(), drill_feed, 1000, 1).why == "the feed is along the tool axis (retract)");
  CHECK(cutting_force(drill(), 0, 1000, -1).why == "the program does not give its feed");
  CHECK(cutting_force(drill(), drill_feed, 0, -1).why == "the program does not give its spindle speed");
}

TEST_CASE("an end mill with a point angle has a thrust in its plunges, and its milling forces stay") {
  CuttingModel mill = sample_cut(), plunging = sample_cut();
  plunging.mill.point_angle = pi;
  CHECK(cutting_force(plunging, 0.04, 6000, 0).F == cutting_force(mill, 0.04, 6000, 0).F);
  const CutForce down = cutting_force(plunging, 0.04, 6000, -1);
  REQUIRE(down.why.empty());
  const CuttingCoefficients& K = mill.coefficients;
  const double F_v = 4 * (K.K_tc * 0.1 * mm + K.K_te) * 5 * mm;
  CHECK(down.F[2] == doctest::Approx(0.9 * F_v));
  CHECK(down.chip_torque == doctest::Approx(4 * K.K_tc * 0.1 * mm * 5 * mm * 2.5 * mm));
}

TEST_CASE("a plunge along a path has the thrust of its rule along the tool") {
  ForceSource source;
  source.rules = {{"drill", {}, {}, respond(drill())}};
  source.blend = 0;
  Program program = ProgramBuilder({0, 0, 20}).rapid({0, 0, 1}).feed({0, 0, -10}, 200).program;
  program.moves.back().spindle_rpm = 1000;
  CHECK(!is_zero(source.rules[0]));
  const Matrix3 tilted = exp_so3(Vector3(0.3, 0, 0));
  Pose X_MW;
  X_MW.R = tilted;
  const Vector6 F = forces_on(program, source, X_MW, tilted).at(1, 0.5);
  const double thrust = cutting_force(drill(), drill_feed, 1000, -1).F[2];
  CHECK((F.head<3>() - thrust * tilted.col(2)).norm() < 1e-9);
}
