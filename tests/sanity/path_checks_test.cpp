#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "counterflex/sanity/checks.hpp"
#include "counterflex/statics/mechanism.hpp"
#include "counterflex/statics/nominal.hpp"

using namespace counterflex;

namespace {

bool shows(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A waypoint of a path along x under the force `F`.
Waypoint cut(const Vector3& F, double length = 1e-3, const Vector3& direction = Vector3::UnitX()) {
  Waypoint w;
  w.cutting = true;
  w.weight = length;
  w.direction = direction;
  w.wrench.head<3>() = F;
  return w;
}

/// An elbow of two rotary axes.
Model elbow() {
  return prepare(read_machine(
      "format = \"counterflex-machine 1\"\ncontrolled = [\"x\", \"y\", \"z\"]\n[[chain]]\nname = "
      "\"arm\"\nelements = [\n"
      "{ actuator = \"prismatic\", axis = \"z\", min_mm = -500, max_mm = 500 },\n"
      "{ actuator = \"revolute\", axis = \"z\", min_deg = -170, max_deg = 170, home_deg = 20 },\n"
      "{ rigid = { xyz_mm = [400, 0, 0] } },\n"
      "{ actuator = \"revolute\", axis = \"z\", min_deg = -150, max_deg = 150, home_deg = 60 },\n"
      "{ rigid = { xyz_mm = [400, 0, 0] } }]\n",
      "elbow.toml"));
}

/// Two linear axes.
Model plate() {
  return prepare(
      read_machine("format = \"counterflex-machine 1\"\ncontrolled = [\"x\", \"y\"]\n[[chain]]\nname = "
                   "\"axes\"\nelements = [\n"
                   "{ actuator = \"prismatic\", axis = \"x\", min_mm = 0, max_mm = 3000 },\n"
                   "{ actuator = \"prismatic\", axis = \"y\", min_mm = 0, max_mm = 100 }]\n",
                   "plate.toml"));
}

}  // namespace

TEST_CASE("the least margin names axis, value, line and travel") {
  const Model model = elbow();
  const Vector3 home = tip(model.mechanism, model.home).p;
  TravelTally tally;
  CHECK(check_travel(model.mechanism, tally, {}).state == SanityState::unknown);
  NominalToolPath path(model);
  int line = 3;
  for (const double z : {0.0, 0.499, 0.3}) {
    REQUIRE(path.go_to(model, home + Vector3(0, 0, z)) == Status::converged);
    tally.add(model.mechanism, actuator_values(model.mechanism, path.configuration()), line++);
  }
  const SanityCheck check = check_travel(model.mechanism, tally, {});
  CHECK(check.state == SanityState::ok);
  CHECK(check.text ==
        "least margin 1.0 mm on axis Z, rapids included: 499.0 mm at line 4, travel -500 to 500 mm; of "
        "rotary axes 90.0 deg on actuator 3: 60.0 deg at line 3, travel -150 to 150 deg");
  CHECK(tally.axes()[0].largest == doctest::Approx(0.499));
  CHECK(tally.axes()[0].margin == doctest::Approx(1 * mm));
  CHECK(tally.axes()[0].line == 4);
  CHECK(tally.axes()[1].line == 3);
}

TEST_CASE("the least margin is the least in mm, not in shares of the travel") {
  const Model model = plate();
  TravelTally tally;
  tally.add(model.mechanism, Eigen::Vector2d(2.97, 0.05), 2);
  tally.add(model.mechanism, Eigen::Vector2d(1.5, 0.008), 3);
  CHECK(check_travel(model.mechanism, tally, {}).text ==
        "least margin 8.0 mm on axis Y, rapids included: 8.0 mm at line 3, travel 0 to 100 mm");
  tally.add(model.mechanism, Eigen::Vector2d(1.5, -0.002), 4);
  CHECK(check_travel(model.mechanism, tally, {}).text ==
        "line 4: axis Y: -2.0 mm is outside its travel (0 to 100 mm)");
}

TEST_CASE("an end of the travel is inside of it, to the rounding of a solution") {
  const Model model = plate();
  TravelTally tally;
  tally.add(model.mechanism, Eigen::Vector2d(1.5, 0.1 + 1e-13), 4);
  const SanityCheck at_limit = check_travel(model.mechanism, tally, {});
  CHECK(at_limit.state == SanityState::ok);
  CHECK(at_limit.text ==
        "least margin 0.0 mm on axis Y, rapids included: 100.0 mm at line 4, travel 0 to 100 mm");
  tally.add(model.mechanism, Eigen::Vector2d(1.5, 0.1 + 1e-6), 5);
  CHECK(check_travel(model.mechanism, tally, {}).state == SanityState::doubtful);
}

TEST_CASE("the least margin is stated with the value of its own line") {
  const Model model = plate();
  TravelTally tally;
  tally.add(model.mechanism, Eigen::Vector2d(1.5, 0.01), 3);
  tally.add(model.mechanism, Eigen::Vector2d(1.5, 0.09), 4);  // as near to the other end
  CHECK(check_travel(model.mechanism, tally, {}).text ==
        "least margin 10.0 mm on axis Y, rapids included: 10.0 mm at line 3, travel 0 to 100 mm");
}

TEST_CASE("rotary axes count on over full turns") {
  const Model model = elbow();
  TravelTally tally;
  int line = 1;
  for (const double angle : {150.0, 190.0 - 360.0, 150.0}) {
    Eigen::VectorXd rho = actuator_values(model.mechanism, model.home);
    rho[1] = angle * deg;
    tally.add(model.mechanism, rho, line++);
  }
  CHECK(tally.axes()[1].largest == doctest::Approx(190 * deg));
  CHECK(tally.axes()[1].margin == doctest::Approx(-20 * deg));
  CHECK(tally.axes()[1].line == 2);
}

TEST_CASE("a force that pushes along the feed nearly everywhere is doubtful") {
  FeedForceTally against, along;
  for (int i = 0; i < 100; ++i) {
    const Vector3 feed(std::cos(0.01 * i), std::sin(0.01 * i), 0);
    against.add(cut(-230 * feed, 1e-3, feed));
    along.add(cut(i < 94 ? Vector3(230 * feed) : Vector3(-feed), 1e-3, feed));
  }
  CHECK(check_feed_force(against).state == SanityState::ok);
  const SanityCheck check = check_feed_force(along);
  CHECK(check.state == SanityState::doubtful);
  CHECK(shows(check.text, "along the feed on 94 % of the path (mean +230 N): is the sense right?"));
  CHECK(check_feed_force(along, true).state == SanityState::ok);
}

TEST_CASE("the feed force of a run that ended before one acted is unknown") {
  const SanityCheck check = check_feed_force({}, false, Failure{ErrorKind::limit, 5, "outside its travel"});
  CHECK(check.state == SanityState::unknown);
  CHECK(check.text == "unknown after line 5, where the run ended");
  CHECK(check_feed_force({}).state == SanityState::ok);
}

TEST_CASE("climb milling on less than three quarters of the path is not doubtful") {
  FeedForceTally tally;
  for (int i = 0; i < 10; ++i) tally.add(cut({i < 7 ? 50.0 : -50.0, 100, 0}));
  CHECK(check_feed_force(tally).state == SanityState::ok);
}

TEST_CASE("a force that keeps its direction around a closed contour is doubtful") {
  FeedForceTally square, straight, axial;
  for (const Vector3& side : {Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(-1, 0, 0), Vector3(0, -1, 0)}) {
    square.add(cut({100, 30, -20}, 0.1, side));
    axial.add(cut({0, 0, -80}, 0.1, side));
    straight.add(cut({-100, 30, -20}, 0.1));
  }
  CHECK(check_feed_force(square).state == SanityState::doubtful);
  CHECK(shows(check_feed_force(square).text, "keeps its direction"));
  CHECK(check_feed_force(axial).state == SanityState::ok);
  CHECK(check_feed_force(straight).state == SanityState::ok);
}

TEST_CASE("rapids, moves without a force and places that were not solved do not count") {
  FeedForceTally tally;
  Waypoint rapid = cut({100, 0, 0}), unsolved = rapid;
  rapid.cutting = false;
  unsolved.status = Status::singular;
  for (const Waypoint& w : {rapid, unsolved, cut(Vector3::Zero())}) tally.add(w);
  CHECK(tally.loaded == 0);
  CHECK(check_feed_force(tally).text == "no force acts on a feed move");
}

TEST_CASE("forces in kN and coarse tolerances are doubtful") {
  CHECK(check_force_size(0).empty());
  CHECK(check_force_size(350).empty());
  REQUIRE(check_force_size(0.35).size() == 1);
  CHECK(shows(check_force_size(0.35)[0].text, "0.35 N"));
  CHECK(check_force_size(3.5e5).size() == 1);
  CHECK(check_tolerance(0.005).empty());
  REQUIRE(check_tolerance(5).size() == 1);
  CHECK(shows(check_tolerance(5)[0].text, "the tolerance is 5 mm"));
}
