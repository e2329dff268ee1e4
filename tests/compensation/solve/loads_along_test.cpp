// Loads along a path: which places are kept, and what is solved there.
#include "counterflex/compensation/loads_along.hpp"

#include "compensation/support/gantry.hpp"
#include "counterflex/machine/machine.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const char* const two_lines = "G21 G90\nG0 X0 Y0 Z0\nG1 X10. F600\nY10.\n";

const Shop& gantry_shop() {
  static const Shop shop(
      {.machine = perfect_gantry(), .text = two_lines, .force = constant_force(milling())});
  return shop;
}

/// A waypoint of the feed move along X, the `i`th.
Waypoint waypoint(int i, double force) {
  Waypoint w;
  w.segment = 1;
  w.line = 3 + i;
  w.cutting = true;
  w.s = i * mm;
  w.p_MT.x() = i * um;
  w.wrench[0] = force;
  return w;
}

std::vector<Waypoint> equal_waypoints(int count) {
  std::vector<Waypoint> all;
  for (int i = 0; i < count; ++i) all.push_back(waypoint(i, 100));
  return all;
}

std::vector<LoadPlace> kept(const std::vector<Waypoint>& waypoints, std::size_t at_once = 1'000'000) {
  const Job job = gantry_shop().job();
  LoadPlaces places;
  for (std::size_t i = 0; i < waypoints.size(); i += at_once)
    places.add(job,
               {waypoints.begin() + static_cast<std::ptrdiff_t>(i),
                waypoints.begin() + static_cast<std::ptrdiff_t>(std::min(i + at_once, waypoints.size()))});
  return places.places();
}

std::vector<int> kept_lines(const std::vector<LoadPlace>& places) {
  std::vector<int> lines;
  for (const LoadPlace& place : places) lines.push_back(place.at.line);
  return lines;
}

bool has_line(const std::vector<LoadPlace>& places, int line) {
  const std::vector<int> lines = kept_lines(places);
  return std::count(lines.begin(), lines.end(), line) == 1;
}

/// Chain by chain, to the last bit.
bool same_loads(const LoadsAlong& a, const LoadsAlong& b) {
  if (a.places.size() != b.places.size() || a.unsolved != b.unsolved) return false;
  for (std::size_t i = 0; i < a.places.size(); ++i)
    for (std::size_t c = 0; c < a.places[i].chains.size(); ++c) {
      if (a.places[i].chains[c].wrench != b.places[i].chains[c].wrench) return false;
      for (const LoadKind kind : load_kinds)
        if (a.places[i].chains[c][kind] != b.places[i].chains[c][kind]) return false;
    }
  return true;
}

}  // namespace

TEST_CASE(
    "of a short path every waypoint is kept, of a long one as many as there is room for, spread evenly") {
  CHECK(kept(equal_waypoints(300)).size() == 300);
  for (const int count : {1021, 2041, 50'000}) {
    CAPTURE(count);
    const auto places = kept(equal_waypoints(count));
    CHECK(places.size() <= LoadPlaces::most);
    CHECK(places.size() > LoadPlaces::most / 2 - 4);
    const std::size_t step = places[1].number - places[0].number;
    for (std::size_t i = 1; i < places.size(); ++i) CHECK(places[i].number - places[i - 1].number == step);
  }
}

TEST_CASE("the largest force of every part of a path is kept, wherever it is and however short it is") {
  for (const int at : {0, 1, 511, 1020, 7'777, 19'999}) {
    CAPTURE(at);
    auto waypoints = equal_waypoints(20'000);
    waypoints[static_cast<std::size_t>(at)].wrench[1] = 300;
    for (std::size_t i = 40; i < waypoints.size(); i += 400) waypoints[i].wrench[0] = 200;
    waypoints[static_cast<std::size_t>(at)].between = at % 2 == 1;
    waypoints[static_cast<std::size_t>(at)].place = at % 2 == 0;
    const auto places = kept(waypoints);
    CHECK(places.size() <= LoadPlaces::most);
    CHECK(has_line(places, 3 + at));
    for (int i = 40; i < 20'000; i += 400)
      if (std::abs(i - at) > 32) CHECK(has_line(places, 3 + i));
  }
}

TEST_CASE("the largest moment and the largest deviation before are kept where the force is like elsewhere") {
  auto waypoints = equal_waypoints(5'000);
  waypoints[1'235].wrench[5] = 7;
  waypoints[3'003].before[2] = 1e-4;
  waypoints[4'003].before[2] = 2e-4;
  waypoints[4'003].place = false;
  waypoints[4'003].between = true;  // what it was before is not known there
  const auto places = kept(waypoints);
  CHECK(has_line(places, 3 + 1'235));
  CHECK(has_line(places, 3 + 3'003));
  CHECK_FALSE(has_line(places, 3 + 4'003));
}

TEST_CASE("places weigh as much as the waypoints that they represent") {
  for (const int count : {10, 5'000}) {
    std::vector<Waypoint> waypoints = equal_waypoints(count);
    double sum = 0, kept_sum = 0;
    for (int i = 0; i < count; ++i) {
      Waypoint& w = waypoints[static_cast<std::size_t>(i)];
      w.weight = (1 + i % 3) * mm;
      w.wrench[0] += i % 7;
      sum += w.weight;
    }
    for (const LoadPlace& place : kept(waypoints)) kept_sum += place.at.weight;
    CHECK(kept_sum == doctest::Approx(sum));
  }
}

TEST_CASE("which places are kept does not depend on where the path is cut into windows") {
  auto waypoints = equal_waypoints(6'000);
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    waypoints[i].wrench[0] = static_cast<double>((i * 7919) % 997);
    waypoints[i].cutting = i % 11 != 0;
  }
  const std::vector<int> whole = kept_lines(kept(waypoints));
  REQUIRE(whole.size() > 500);
  for (const std::size_t at_once : {1u, 7u, 1020u, 4000u}) {
    CAPTURE(at_once);
    CHECK(kept_lines(kept(waypoints, at_once)) == whole);
  }
}

TEST_CASE("rapids and waypoints that were not solved have no loads, nor has a move from an unknown place") {
  auto waypoints = equal_waypoints(4);
  waypoints[0].cutting = false;
  waypoints[1].status = Status::singular;
  waypoints[2].segment = no_segment;
  waypoints[2].cutting = false;
  CHECK(kept_lines(kept(waypoints)) == std::vector{6});
  CHECK(kept({}).empty());
}

TEST_CASE("a place has the target that was written, behind a datum that was touched off, too") {
  const Vector3 shift(1 * mm, -2 * mm, 0.5 * mm);
  const Shop shop({.machine = displaced_gantry(),
                   .text = two_lines,
                   .force = constant_force(milling()),
                   .datum_shift = shift});
  const Compensation result = compensated(shop, true);
  LoadPlaces places;
  places.add(shop.job(), result.waypoints);
  REQUIRE(!places.places().empty());
  const LoadPlace last = places.places().back();
  const Vector3 wanted = Vector3(10, 10, 0) * mm + shift;
  CHECK((result.waypoints.back().p_MT - wanted).norm() < 1e-12);
  CHECK((last.target - wanted - shift_mm * mm).norm() < 1e-6);
  CHECK(last.load.F == milling());
}

TEST_CASE("loads at a place are those of the machine that is commanded to go there, under the force there") {
  const Shop shop({.machine = read_machine(read_file(orthoglide_b), "orthoglide"),
                   .text = "G21 G90\nG0 X0 Y0 Z0\nG1 X20. Y5. F600\nG2 X10. Y-10. R15.\n",
                   .force = constant_force(milling())});
  const Compensation result = compensated(shop, true);
  LoadPlaces kept_places;
  kept_places.add(shop.job(), result.waypoints);
  const auto places = kept_places.places();
  const LoadsAlong along = solve_loads(shop.model, places, 1);
  REQUIRE(along.places.size() == places.size());
  REQUIRE(places.size() > 5);
  CHECK(along.unsolved == 0);
  StaticsWork work(shop.model.mechanism);
  for (std::size_t i = 0; i < places.size(); i += 3) {
    CAPTURE(i);
    const Pose X_MT{tip(shop.model.mechanism, shop.model.home).R, places[i].target};
    const NominalResult nominal = follow(shop.model, shop.model.home, X_MT);
    const Equilibrium alone = solve_forward(shop.model, nominal.configuration, places[i].load, {}, work);
    REQUIRE(alone.status == Status::converged);
    // The command puts the tip where it is wanted: no other command's loads are meant.
    const auto found = std::find_if(result.waypoints.begin(), result.waypoints.end(), [&](const Waypoint& w) {
      return w.cutting && w.s == places[i].at.s &&
             (w.p_MT - tip(shop.model.mechanism, alone.configuration).p).norm() < 5e-6;
    });
    CHECK(found != result.waypoints.end());
    const auto expected = loads(shop.model.mechanism, shop.model, alone.configuration);
    REQUIRE(along.places[i].chains.size() == 3);
    CHECK(along.places[i].line == places[i].at.line);
    for (std::size_t c = 0; c < 3; ++c) {
      CHECK(along.places[i].chains[c].name == expected[c].name);
      for (const LoadKind kind : load_kinds)
        CHECK(along.places[i].chains[c][kind] == doctest::Approx(expected[c][kind]).epsilon(1e-6));
    }
  }
}

TEST_CASE("loads are the same to the last bit for any number of threads" * doctest::test_suite("long")) {
  std::string text = "G21 G90\nG0 X0 Y0 Z0\nF600\n";
  for (int i = 1; i <= 700; ++i) text += fmt::format("G1 X{:.3f} Y{:.3f}\n", 0.03 * i, i % 2 ? 3.0 : 0.0);
  const Shop shop({.machine = read_machine(read_file(orthoglide_b), "orthoglide"),
                   .text = text,
                   .force = constant_force(milling())});
  const Job job = shop.job();
  LoadPlaces places;
  places.add(job, solve_pieces(job, original_pieces(job), {.attribution = true, .inside = false}).waypoints);
  REQUIRE(places.places().size() > 600);  // several chunks
  const LoadsAlong one = solve_loads(shop.model, places.places(), 1);
  CHECK(one.unsolved == 0);
  CHECK(one.places.front().chains.front().wrench.norm() > 1);
  CHECK(same_loads(one, solve_loads(shop.model, places.places(), 3)));
}

TEST_CASE("places are solved with their own tools, and their loads are those of the machine's own chains") {
  Machine machine = read_machine(read_file(orthoglide_b), "orthoglide");
  machine.tools = {{1, {.from = ToolStiffness::radial, .yields = radial_tool(1e6)}}};
  const Shop shop({.machine = machine,
                   .text = "G21 G90\nT1 M6\nG0 X0 Y0 Z0\nG1 X20. F600\nT2 M6\nG1 X0\n",
                   .force = constant_force(milling())});
  REQUIRE(shop.tools.size() == 1);
  const Compensation result = compensated(shop, true);
  LoadPlaces places;
  places.add(shop.job(), result.waypoints);
  const LoadsAlong along = solve_loads(shop.model, places.places(), 1);
  CHECK(along.unsolved == 0);
  REQUIRE(!along.places.empty());
  CHECK(places.places().front().model == &shop.tools.at(1));
  CHECK(places.places().back().model == &shop.model);
  for (const LoadsAtPlace& place : along.places) {
    REQUIRE(place.chains.size() == 3);
    for (std::size_t c = 0; c < 3; ++c) CHECK(place.chains[c].name == machine.chains[c].name);
  }
}

TEST_CASE("a place that the machine does not reach is counted, and those behind it are solved") {
  auto waypoints = equal_waypoints(5);
  const Shop shop({.machine = read_machine(read_file(orthoglide_b), "orthoglide"),
                   .text = two_lines,
                   .force = constant_force(milling())});
  waypoints[2].p_MT = Vector3(5, 5, 5);
  LoadPlaces places;
  places.add(shop.job(), waypoints);
  const LoadsAlong along = solve_loads(shop.model, places.places(), 1);
  CHECK(along.unsolved == 1);
  REQUIRE(along.places.size() == 4);
  CHECK(along.places[2].line == 3 + 3);
}
