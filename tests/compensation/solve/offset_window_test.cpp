// By how much a work offset may be off, on machines whose deviation is known in closed form.
#include "counterflex/compensation/offset_window.hpp"

#include <cmath>

#include "compensation/support/gantry.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const char* const contour = "G21 G90 G54\nG0 X0 Y0 Z0\nG1 X40. F600\nY30.\nX0.\nY0.\n";

/// A program corrected for a machine, with the places of its path.
struct CorrectedPath {
  Machine machine;
  Shop shop;
  std::vector<LoadPlace> places;

  explicit CorrectedPath(const Machine& of, const std::string& text = contour, double tolerance = 5e-6)
      : machine(of), shop({.machine = of, .text = text, .tolerance = tolerance}) {
    const Compensation run = compensate(shop.job(), false);
    REQUIRE_FALSE(run.failure);
    LoadPlaces kept(KeptPlace::largest_rest);
    kept.add(shop.job(), run.waypoints);
    places = kept.places();
    REQUIRE(places.size() > 4);
  }

  OffsetQuestion question() const { return {places, shop.options, machine, shop.model, shop.path.frames}; }

  std::optional<double> window_mm() const {
    const std::optional<double> window = offset_window(question());
    return window ? std::optional(std::round(*window / um) * 1e-3) : std::nullopt;
  }
};

/// The largest step whose corners stay within the tolerance on a gantry whose Y leans towards X by `angle`: a
/// shift along Y by y moves the tip by (-sin, cos - 1) y more.
double window_of_leaning_y(const CorrectedPath& path, double angle) {
  const auto holds = [&](double step) {
    for (const LoadPlace& place : path.places)
      for (const double y : {-step, step}) {
        const Vector3 change = y * mm * Vector3(-std::sin(angle), std::cos(angle) - 1, 0);
        if ((place.at.after.head<3>() + change).norm() > path.shop.options.tolerance) return false;
      }
    return true;
  };
  return *std::find_if(std::begin(window_steps_mm), std::end(window_steps_mm), holds);
}

}  // namespace

TEST_CASE("the window of a machine without errors is the largest one, which is documented") {
  CHECK(CorrectedPath(perfect_gantry()).window_mm() == 10);
  CHECK(CorrectedPath(displaced_gantry()).window_mm() == 10);
}

TEST_CASE("the window of a machine that is not square ends where a corner uses up the tolerance") {
  double last = 20;
  for (const double angle : {0.3e-3, 0.7e-3, 1.5e-3, 4e-3, 9e-3}) {
    CAPTURE(angle);
    const CorrectedPath path(rigid_gantry("0, 0, 0", angle));
    const double expected = window_of_leaning_y(path, angle);
    CHECK(path.window_mm() == expected);
    CHECK(expected < last);
    last = expected;
    CHECK(window_holds(path.question(), expected * mm));
    if (expected < window_steps_mm[0]) CHECK_FALSE(window_holds(path.question(), 1.3 * expected * mm));
  }
}

TEST_CASE(
    "there is no window below the smallest step, and a place that need not keep the tolerance may get "
    "worse") {
  CorrectedPath path(rigid_gantry("0, 0, 0", 0.02));
  CompensationOptions tight = path.shop.options;
  tight.tolerance = 1e-7;  // rounded words leave more
  OffsetQuestion question{path.places, tight, path.machine, path.shop.model, path.shop.path.frames};
  CHECK_FALSE(offset_window(question));
  for (LoadPlace& place : path.places) place.at.exempt = true;
  CHECK(window_holds(question, 0.4e-6));  // by 0.02 of it, a tenth of the tolerance is 1e-8
  CHECK_FALSE(window_holds(question, 20e-6));
}

TEST_CASE("a datum that is touched off again moves the wanted path as the machine moves the tool") {
  const double angle = 4e-3;  // the deviation changes evenly, at the touched point as on the path
  CorrectedPath path(rigid_gantry("0, 0, 0", angle));
  CHECK(path.window_mm() < 10);
  path.machine.work["G54"] = {Pose{}, {.touched_at = Vector3(5, 5, 0) * mm}};
  for (WorkFrame& frame : path.shop.path.frames) frame.name = "G54";
  CHECK(path.window_mm() == 10);
}

TEST_CASE("a corner outside of the travel does not hold") {
  const std::string far = "G21 G90 G54\nG0 X900. Y0 Z0\nG1 X997.9 F600\nY10.\nX900.\nY0.\n";
  CHECK(CorrectedPath(perfect_gantry(), far).window_mm() == 2);
}

TEST_CASE("a frame that is turned in the machine is shifted along its own axes, too") {
  const double angle = 1.5e-3;
  CorrectedPath path(rigid_gantry("0, 0, 0", angle));
  const double along_axes = *path.window_mm();
  for (WorkFrame& frame : path.shop.path.frames) frame.X_MW.R = exp_so3(45 * deg * Vector3::UnitZ());
  CHECK(*path.window_mm() < along_axes);        // a corner along the work's axes is further along Y
  CHECK(*path.window_mm() > along_axes / 2.1);  // by the square root of two
}

TEST_CASE("the place that uses up most of the tolerance is kept of each stretch") {
  const CorrectedPath path(rigid_gantry("0, 0, 0", 1e-3));
  const Job job = path.shop.job();
  std::vector<Waypoint> many;
  for (int i = 0; i < 20'000; ++i) {
    Waypoint& w = many.emplace_back(path.places[1].at);
    w.line = i;
    w.after.setZero();
    w.after[1] = i == 7'777 ? 4e-6 : 1e-6;
    w.wrench.setZero();
  }
  LoadPlaces kept(KeptPlace::largest_rest);
  kept.add(job, many);
  const auto places = kept.places();
  CHECK(places.size() <= LoadPlaces::most);
  CHECK(std::any_of(places.begin(), places.end(), [](const LoadPlace& p) { return p.at.line == 7'777; }));
}
