#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "forces/sample_cut.hpp"
#include "forces/sample_path.hpp"

using namespace counterflex;
using test::constant;
using test::forces_on;
using test::from_csv;
using test::linear;
using test::near;
using test::ProgramBuilder;
using test::wrench;

namespace {

const std::string feed_frame = "# frame = feed\n# sense = on_tool\n";

/// 10 mm along x, a tangential quarter to the left about (10, 10) of radius 10, 10 mm along y; 10 mm/s.
Program line_quarter_line() {
  return ProgramBuilder({0, 0, 0})
      .feed({10, 0, 0}, 600)
      .arc({20, 10, 0}, {10, 10, 0}, 600)
      .feed({20, 20, 0}, 600)
      .program;
}

/// (along, to the left, 0) in the direction `angle` from x.
Vector6 turned(double angle, double along, double left, double axial) {
  const double c = std::cos(angle), s = std::sin(angle);
  return wrench(c * along - s * left, s * along + c * left, axial);
}

}  // namespace

TEST_CASE("a constant force in the feed frame stays tangential all along a quarter circle") {
  const auto forces =
      forces_on(line_quarter_line(), from_csv(feed_frame + "line,fx_N,fy_N,fz_N\n1,100,30,-5\n"));
  CHECK(near(forces.at(0, 0.3), wrench(100, 30, -5)));
  for (int k = 0; k <= 1000; ++k) {
    const double u = k / 1000.0;
    CAPTURE(u);
    CHECK(near(forces.at(1, u), turned(u * 90 * deg, 100, 30, -5), 1e-4 * 105));
  }
  CHECK(near(forces.at(2, 0.3), wrench(-30, 100, -5)));
}

TEST_CASE("a clockwise arc turns the feed frame to the right") {
  const Program program = ProgramBuilder({0, 0, 0}).arc({10, -10, 0}, {0, -10, 0}, 600, true).program;
  const auto forces = forces_on(program, from_csv(feed_frame + "line,fx_N,fy_N,fz_N\n1,100,30,-5\n"));
  for (const double u : {0.0, 0.21, 0.5, 0.83, 1.0})
    CHECK(near(forces.at(0, u), turned(-u * 90 * deg, 100, 30, -5), 1e-4 * 105));
}

TEST_CASE("a wrench that turns smoothly has no corner, on the arc or where lines join it") {
  for (const double blend : {0.0, 2 * mm}) {
    const auto forces =
        forces_on(line_quarter_line(), from_csv(feed_frame + "line,fx_N,fy_N,fz_N\n1,100,0,0\n", blend));
    CHECK(forces.breaks(1).empty());
    CHECK(forces.breaks(2).empty());
    CHECK(forces.ramps() + forces.jumps() == 1);  // the entry
  }
}

TEST_CASE("a step of the profile inside an arc is a corner there and nowhere else") {
  const double quarter = 10 * 90 * deg;
  const auto rows = fmt::format("s_mm,fx_N,fy_N,fz_N\n0,100,0,0\n{},200,0,0\n", 10 + quarter / 2);
  const auto forces = forces_on(line_quarter_line(), from_csv(feed_frame + rows));
  REQUIRE(forces.breaks(1).size() == 1);
  CHECK(forces.breaks(1)[0] == doctest::Approx(0.5));
  CHECK(near(forces.at(1, 0.5, Side::before), turned(45 * deg, 100, 0, 0), 0.02));
  CHECK(near(forces.at(1, 0.5, Side::after), turned(45 * deg, 200, 0, 0), 0.02));
}

TEST_CASE("a linear profile in the feed frame grows and turns together") {
  const double quarter = 10 * 90 * deg;
  const auto rows = fmt::format("s_mm,fx_N,fy_N,fz_N\n0,0,0,0\n10,0,0,0\n{},500,0,0\n{},500,0,0\n",
                                10 + quarter, 20 + quarter);
  const auto forces =
      forces_on(line_quarter_line(), from_csv(feed_frame + "# interpolation = linear\n" + rows));
  for (int k = 0; k <= 50; ++k)
    CHECK(near(forces.at(1, k / 50.0), turned(k / 50.0 * 90 * deg, 10 * k, 0, 0), 1e-4 * 500));
}

TEST_CASE("on an arc the blended wrench is the mean of the turning one over the last stretch") {
  const auto source = feed_frame + "line,fx_N,fy_N,fz_N\n1,100,30,-5\n";
  const auto blended = forces_on(line_quarter_line(), from_csv(source, 2 * mm));
  const double b = 2.0 / 10;  // rad
  for (const double u : {0.2, 0.5, 0.9}) {
    const double a = u * 90 * deg;
    // 1/b int_(a-b)^a (cos, sin)(angle) d angle
    const double c = (std::sin(a) - std::sin(a - b)) / b, s = (std::cos(a - b) - std::cos(a)) / b;
    CHECK(near(blended.at(1, u), wrench(100 * c - 30 * s, 100 * s + 30 * c, -5), 1e-4 * 105));
  }
}

TEST_CASE("a helix about the tool's axis turns the feed frame like its circle") {
  const Program program = ProgramBuilder({10, 0, 0}).arc({10, 0, -3}, {0, 0, 0}, 600).program;
  const auto forces = forces_on(program, from_csv(feed_frame + "line,fx_N,fy_N,fz_N\n1,100,30,-5\n"));
  for (const double u : {0.0, 0.125, 0.4, 0.77, 1.0})
    CHECK(near(forces.at(0, u), turned((90 + 360 * u) * deg, 100, 30, -5), 1e-4 * 105));
  CHECK(forces.breaks(0).empty());
}

TEST_CASE("where an upright arc passes the tool's own direction the feed frame flips, and the wrench steps") {
  // G18 full circle from its lowest point: along x, up, back, down, along x.
  const Program program =
      ProgramBuilder({0, 0, -10}).feed({0, 0, -10}, 600).about({0, 0, 0}, 1, true).program;
  const auto forces = forces_on(program, from_csv(feed_frame + "line,fx_N,fy_N,fz_N\n1,100,0,-5\n"));
  const double first = forces.at(0, 0.1)[0];
  CHECK(std::abs(first) == doctest::Approx(100));
  for (const double u : {0.0, 0.1, 0.2499, 0.7501, 0.9, 1.0})
    CHECK(near(forces.at(0, u), wrench(first, 0, -5), 0.01));
  for (const double u : {0.2501, 0.5, 0.7499}) CHECK(near(forces.at(0, u), wrench(-first, 0, -5), 0.01));
  CHECK(forces.breaks(0).size() == 2);
  CHECK(forces.notes().empty());
}

TEST_CASE("a constant force and forces in machine axes do not turn on arcs") {
  CHECK(forces_on(line_quarter_line(), constant(wrench(1, 2, 3), 0)).at(1, 0.7) == wrench(1, 2, 3));
  const auto forces =
      forces_on(line_quarter_line(), from_csv(test::on_tool + "line,fx_N,fy_N,fz_N\n1,1,2,3\n"));
  CHECK(forces.at(1, 0.7) == wrench(1, 2, 3));
}

TEST_CASE("a force in the tool frame follows a turning tool, without corners") {
  const Program program = ProgramBuilder({0, 0, 0}).feed({10, 0, 0}, 600).feed({20, 0, 0}, 600).program;
  const auto path = build_toolpath(program, one_frame(program, {}));
  std::vector<Matrix3> R_MT;  // 20 degrees on the first move, 40 on the second, evenly
  for (const double angle : {0.0, 10.0, 20.0, 20.0, 40.0, 60.0}) R_MT.push_back(exp_so3({0, 0, angle * deg}));
  const auto source = from_csv("# frame = tool\n# sense = on_tool\nline,fx_N,fy_N,fz_N\n1,100,30,-5\n");
  const PathForces forces(source, program, path, R_MT);
  for (const double u : {0.0, 0.1, 0.5, 0.77, 1.0}) {
    CHECK(near(forces.at(0, u), turned(20 * u * deg, 100, 30, -5), 1e-4 * 105));
    CHECK(near(forces.at(1, u), turned((20 + 40 * u) * deg, 100, 30, -5), 1e-4 * 105));
  }
  CHECK(forces.breaks(0).empty());
  CHECK(forces.breaks(1).empty());
  CHECK(forces.jumps() == 1);
}

TEST_CASE("on an upright arc the force of a cut steps where the feed is 10 degrees off the tool axis") {
  // In the plane of X and Z about the origin, at angles from straight down towards X, in a frame that is
  // tilted about X. In the second case the feed is along the axis for two degrees alone.
  struct Step {
    double angle_deg;
    int to_steep;  // direction
  };
  struct Case {
    double from_deg, to_deg, tilt_deg;
    std::vector<Step> steps;
  };
  const double off = std::acos(std::cos(10 * deg) / std::cos(9.95 * deg)) / deg;
  CuttingModel model = test::sample_cut();
  model.spindle_rpm = 6000;
  ForceSource source;
  source.rules = {{"cut", {}, {}, respond(model)}};
  for (const Case& one :
       {Case{0, 180, 0, {{10, -1}, {170, 1}}}, Case{-61.3, 60, 9.95, {{-off, 1}, {off, -1}}}}) {
    CAPTURE(one.tilt_deg);
    const auto place = [](double angle_deg) {
      return Vector3(-150 * std::cos(angle_deg * deg), 0, -150 * std::sin(angle_deg * deg));
    };
    const Program program =
        ProgramBuilder(place(one.from_deg)).feed(place(one.to_deg), 600).about({0, 0, 0}, 1, true).program;
    const double sweep = one.to_deg - one.from_deg, blend = 2 / (150 * sweep * deg);
    const Pose X_MW{exp_so3({one.tilt_deg * deg, 0, 0}), Vector3::Zero()};
    source.blend = 0;
    const auto forces = forces_on(program, source, X_MW);
    source.blend = 2 * mm;
    const auto blended = forces_on(program, source, X_MW);
    const auto breaks_at = [](const PathForces& f, double u) {
      return std::ranges::any_of(f.breaks(0), [&](double v) { return std::abs(u - v) < 1e-6; });
    };
    for (const Step& step : one.steps) {
      CAPTURE(step.angle_deg);
      const double u = (step.angle_deg - one.from_deg) / sweep, beside = u - step.to_steep * 1e-5;
      CHECK(breaks_at(forces, u));
      CHECK(breaks_at(blended, u));
      CHECK(breaks_at(blended, u + blend));
      CHECK(forces.at(0, u + step.to_steep * 1e-5) == Vector6::Zero());
      const double slope = -std::cos(one.tilt_deg * deg) * std::cos((one.from_deg + beside * sweep) * deg);
      const double size = cutting_force(model, 0.01, 0, slope).F.head<3>().norm();
      CHECK(size > 70);
      CHECK(forces.at(0, beside).head<3>().norm() == doctest::Approx(size).epsilon(1e-3));
    }
  }
}

TEST_CASE(
    "an arc that ends at the steepest ramp, and one at the end of a very long path, have finite forces") {
  CuttingModel model = test::sample_cut();
  model.spindle_rpm = 6000;
  ForceSource source;
  source.rules = {{"cut", {}, {}, respond(model)}};
  source.blend = 2 * mm;
  const auto place = [](double angle) { return Vector3(-50 * std::cos(angle), 0, -50 * std::sin(angle)); };
  for (const double beside : {0.0, 1e-13, -1e-13, 1e-11, -1e-11, 1e-9, -1e-9, 1e-7, -1e-7})
    for (const double from : {0.0, 40 * deg})
      for (const double far_mm : {0.0, 1e10}) {
        CAPTURE(beside);
        CAPTURE(from);
        CAPTURE(far_mm);
        const Program program = ProgramBuilder(place(from) - Vector3(far_mm, 0, 0))
                                    .feed(place(from), 600)
                                    .feed(place(10 * deg + beside), 600)
                                    .about({0, 0, 0}, 1, from == 0)
                                    .program;
        const auto forces = forces_on(program, source);
        const std::size_t arc = far_mm == 0 ? 0 : 1;
        for (int k = 0; k <= 20; ++k) CHECK(forces.at(arc, k / 20.0).allFinite());
      }
}
