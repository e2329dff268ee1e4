// Deviation at rim and flank of a tilted tool.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "counterflex/geometry/types.hpp"
#include "counterflex/report/formats.hpp"
#include "counterflex/report/statistics.hpp"
#include "made_up_run.hpp"
#include "support/text.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// |d + phi x r| at many angles of the circle.
double largest_sampled(const Vector6& deviation, const Vector3& axis, double radius, double height) {
  const Vector3 u = axis.unitOrthogonal(), v = axis.cross(u);
  const Vector3 d = deviation.head<3>(), phi = deviation.tail<3>();
  double largest = 0;
  constexpr int count = 20000;
  for (int k = 0; k < count; ++k) {
    const double alpha = 2 * std::numbers::pi * k / count;
    const Vector3 r = height * axis + radius * (std::cos(alpha) * u + std::sin(alpha) * v);
    largest = std::max(largest, (d + phi.cross(r)).norm());
  }
  return largest;
}

/// A waypoint of the made-up run whose tool is tilted after the correction.
std::vector<Waypoint> tilted(double tilt) {
  std::vector<Waypoint> list = made_up_waypoints();
  for (Waypoint& w : list) {
    w.before.tail<3>() = Vector3(tilt, 0, 0);
    w.after.setZero();
    w.after[4] = tilt;
    w.after[2] = 1e-6;
  }
  return list;
}

RunTally tally_with(const MadeUpRun& run, std::vector<ToolSize> sizes,
                    const std::vector<Waypoint>& waypoints) {
  RunTally tally(2, {}, std::move(sizes));
  tally.add_window(run.job);
  tally.add_waypoints(waypoints, run.job);
  return tally;
}

}  // namespace

TEST_CASE("the largest displacement of a circle around a tilted tool is that of a dense sampling") {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Vector3(normal(random), normal(random), normal(random)); };
  for (int i = 0; i < 50; ++i) {
    const Vector3 axis = vector().normalized();
    Vector6 deviation;
    deviation.head<3>() = 20e-6 * vector();
    Vector3 phi = 2e-3 * vector();
    phi -= phi.dot(axis) * axis;
    deviation.tail<3>() = phi;
    for (const double height : {0.0, 0.03}) {
      CAPTURE(i);
      CAPTURE(height);
      const double exact = largest_on_circle(deviation, axis, 0.01, height);
      CHECK(exact == doctest::Approx(largest_sampled(deviation, axis, 0.01, height)).epsilon(1e-7));
    }
  }
}

TEST_CASE("a tilt about the tip lifts the rim by radius times angle, and moves the flank sideways too") {
  Vector6 deviation = Vector6::Zero();
  deviation[3] = 1e-3;
  CHECK(largest_on_circle(deviation, Vector3::UnitZ(), 0.01, 0) == doctest::Approx(10e-6));
  CHECK(largest_on_circle(deviation, Vector3::UnitZ(), 0.01, 0.03) ==
        doctest::Approx(std::hypot(30e-6, 10e-6)));
  deviation[2] = -4e-6;  // the tip is off, too
  CHECK(largest_on_circle(deviation, Vector3::UnitZ(), 0.01, 0) == doctest::Approx(14e-6));
}

TEST_CASE("a rotation of the tool about its own axis moves neither rim nor flank") {
  Vector6 deviation = Vector6::Zero();
  deviation[1] = 3e-6;
  deviation[5] = 0.1;
  CHECK(largest_on_circle(deviation, Vector3::UnitZ(), 0.01, 0.02) == doctest::Approx(3e-6));
}

TEST_CASE(
    "the report has tip, rim and flank of each tool, before and after, and warns where the tip hides them") {
  const MadeUpRun run;
  const double tilt = 1e-3;
  const RunTally tally = tally_with(run, {{0, 0.02, 0.03}}, tilted(tilt));
  const Measures measures = tally.path().measures();
  REQUIRE(measures.tools.size() == 1);
  const ToolTally& tool = measures.tools.at(0);
  REQUIRE(tool.after.largest());
  CHECK(tool.after.largest()->tip_mm == doctest::Approx(0.001));
  CHECK(*tool.after.largest()->rim_mm == doctest::Approx(0.011));
  CHECK(*tool.after.largest()->flank_mm == doctest::Approx(std::hypot(0.03, 0.011)));
  CHECK(tool.after.largest()->tilt_deg == doctest::Approx(tilt / deg));
  CHECK(tool.after.largest()->line == 4);
  CHECK(*tool.before.largest()->rim_mm > 0.5);
  const Overview overview = overview_of(run.program);
  RunContext context = run.context(overview);
  CompensationOptions options;
  options.tolerance = 5e-6;
  const RunContext asked{context.machine, options, context.frames, context.program, context.facts};
  const RunReport report = report_compensation(asked, tally, std::nullopt);
  const std::string text = details_text(report, false);
  CHECK(contains(text, "[tool] (20 mm): tip"));
  CHECK(contains(text, "  rim"));
  CHECK(contains(text, "  flank, 30 mm up"));
  CHECK(contains(text, "[tool] (20 mm) stays tilted by up to 0.0573 deg: its rim is off by up to 0.0110 mm"));
  CHECK(contains(to_json(report), "\"rim_mm\": 0.011"));
}

TEST_CASE("a tool whose diameter is not known has a tilt and no rim") {
  const MadeUpRun run;
  const RunTally tally = tally_with(run, {}, tilted(1e-3));
  const Measures measures = tally.path().measures();
  const ToolDeviation& after = *measures.tools.at(0).after.largest();
  CHECK_FALSE(after.rim_mm);
  CHECK_FALSE(after.flank_mm);
  CHECK(after.tilt_deg == doctest::Approx(1e-3 / deg));
  const Overview overview = overview_of(run.program);
  const RunReport report = report_compensation(run.context(overview), tally, std::nullopt);
  const std::string text = details_text(report, false);
  CHECK(contains(text, "[tool]: diameter unknown, tilt deg"));
  CHECK_FALSE(contains(text, "stays tilted"));
  CHECK(contains(to_json(report), "\"rim_mm\": null"));
}

TEST_CASE("the deviation before is the common shift and the rest") {
  MadeUpRun run;
  run.path.frames[0].common_shift = Vector3(0, 0.3, 0) * mm;
  const RunReport report = predicted(run, made_up_waypoints());
  REQUIRE(report.common_shift);
  CHECK(report.common_shift->largest_mm() == doctest::Approx(0.3));
  // 0.3 mm along y become nothing, (0.3, 0, -0.4) and 0 become larger.
  CHECK(report.common_shift->rest.max_mm == doctest::Approx(std::hypot(0.5, 0.3)));
  CHECK(contains(details_text(report, false), "common shift (datum not stated)         0.3000"));
  run.path.frames[0].common_shift.reset();
  const RunReport stated = predicted(run, made_up_waypoints());
  CHECK_FALSE(stated.common_shift);
  CHECK_FALSE(contains(details_text(stated, false), "common shift"));
  CHECK(contains(to_json(stated), "\"common_shift\": null"));
}
