#include <doctest/doctest.h>

#include "forces/sample_cut.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

// 4 flutes at 6000/min and 2400 mm/min: 0.1 mm.
constexpr double feed = 0.04, rpm = 6000;

std::string why(double feed_m_s, double spindle_rpm, double slope) {
  const CutForce force = cutting_force(sample_cut(), feed_m_s, spindle_rpm, slope);
  if (!force.why.empty()) CHECK(force.F == Vector6::Zero());
  return force.why;
}

}  // namespace

TEST_CASE("a move's feed and spindle speed give its feed per tooth, and that its force") {
  const CutForce force = cutting_force(sample_cut(), feed, rpm, 0);
  CHECK(force.why.empty());
  CHECK(force.feed_per_tooth == doctest::Approx(0.1 * mm).epsilon(1e-12));
  CHECK(agree(force.F, at_feed_per_tooth(sample_cut(), 0.1 * mm), 1e-12));
}

TEST_CASE("forces are affine in the feed") {
  for (const ForceAt force_at : {ForceAt::mean, ForceAt::surface}) {
    CuttingModel model = with_helix(at_wall(sample_cut(), Wall::both), 30);
    model.force_at = force_at;
    const auto at = [&](double part) { return cutting_force(model, part * feed, rpm, 0).F; };
    CHECK(agree(at(1) - at(0.5), at(0.75) - at(0.25), 1e-12));
    CHECK(agree(at(2) - at(1), 2 * (at(1) - at(0.5)), 1e-12));
    CHECK(at(1e-9).norm() > 1);  // the edge
  }
}

TEST_CASE("a model's own spindle speed replaces the program's") {
  CuttingModel model = sample_cut();
  model.spindle_rpm = 12000;
  CHECK(cutting_force(model, feed, rpm, 0).feed_per_tooth == doctest::Approx(0.05 * mm));
  CHECK(cutting_force(model, feed, 0, 0).why.empty());
}

TEST_CASE("a ramp is cut with the lateral part of its feed") {
  for (const double slope : {-0.6, 0.6}) {
    const CutForce ramp = cutting_force(sample_cut(), feed, rpm, slope);
    CHECK(ramp.feed_per_tooth == doctest::Approx(0.08 * mm));
    CHECK(agree(ramp.F, cutting_force(sample_cut(), 0.8 * feed, rpm, 0).F, 1e-12));
  }
}

TEST_CASE("a plunge, a retract, a missing feed and a missing spindle speed give no force, with the reason") {
  CHECK(why(feed, rpm, -1) == "the feed is along the tool axis (plunge)");
  CHECK(why(feed, rpm, 1) == "the feed is along the tool axis (retract)");
  CHECK(why(feed, rpm, -std::sin(80.01 * deg)) == "the feed is along the tool axis (plunge)");
  CHECK(why(feed, rpm, std::sin(80.01 * deg)) == "the feed is along the tool axis (retract)");
  CHECK(why(feed, rpm, -std::sin(79.99 * deg)).empty());
  CHECK(why(feed, rpm, std::sin(79.99 * deg)).empty());
  CHECK(why(0, rpm, 0) == "the program does not give its feed");
  CHECK(why(feed, 0, 0) == "the program does not give its spindle speed");
}

TEST_CASE("the reason for a plunge without feed and speed is the feed along the tool axis") {
  CHECK(why(0, 0, -1) == "the feed is along the tool axis (plunge)");
}
