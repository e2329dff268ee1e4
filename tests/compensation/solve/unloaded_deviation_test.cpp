// Common shifts: what touching off would remove of the deviation of a path.
#include "compensation/support/gantry.hpp"
#include "compensation/support/judge.hpp"
#include "counterflex/compensation/loads_along.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

PathPlaces places_of(const std::string& text) {
  PathPlaces places;
  places.add(read_program(text, "part.ngc", {}));
  return places;
}

const char* const square =
    "G21 G90 G54\nG0 X0 Y0 Z0\nG1 X100 F600\nY100\nX0\nY0\nG0 Z50\nG55\nG0 X0 Y0 Z0\nG1 X0.5\nM30\n";

}  // namespace

TEST_CASE("places are at equal distances along the feed moves of an offset, at most 64") {
  const PathPlaces places = places_of(square);
  const auto of_54 = places.of("G54");
  REQUIRE(of_54.size() >= 32);
  REQUIRE(of_54.size() <= PathPlaces::most);
  const double spacing = of_54[1].p_mm.x();
  for (std::size_t k = 0; k < of_54.size(); ++k) {
    const double s = spacing * static_cast<double>(k);
    const Vector3 wanted = s <= 100   ? Vector3(s, 0, 0)
                           : s <= 200 ? Vector3(100, s - 100, 0)
                           : s <= 300 ? Vector3(300 - s, 100, 0)
                                      : Vector3(0, 400 - s, 0);
    CHECK((of_54[k].p_mm - wanted).norm() < 1e-9);
  }
  CHECK(spacing * static_cast<double>(of_54.size()) > 400);
  CHECK(places.of("G55").size() > 1);  // a short way has places, too
  CHECK(places.of("").empty());
  CHECK(places.of("G59").empty());
}

TEST_CASE(
    "places in a frame whose pose the program gives are in the machine frame, apart from those of its "
    "offset") {
  Program program = read_program(square, "part.ngc", {});
  const ProgramFrame in_table = program.frames[program.moves.back().frame];
  ProgramFrame& given = program.frames[program.moves.back().frame];
  given.pose_mm = Pose{exp_so3(Vector3(0, 0, pi / 2)), Vector3(10, 20, 30)};
  PathPlaces places;
  places.add(program);
  CHECK(PathPlaces::offset_of(in_table) == "G55");
  CHECK(places.of("G55").empty());
  const auto in_machine = places.of(PathPlaces::offset_of(given));
  REQUIRE(in_machine.size() > 1);
  CHECK(std::abs(in_machine.back().p_mm.x() - 10) < 1e-9);
  CHECK(in_machine.back().p_mm.y() > 20.4);
  ProgramFrame set = in_table;
  set.set_mm[1] = 15;
  CHECK(PathPlaces::offset_of(set) != "G55");
}

TEST_CASE("holes of cycles have places, from the height where the feed begins to the bottom") {
  const PathPlaces places = places_of("G21 G90 G54\nG0 X0 Y0 Z5\nG81 X10 Y20 Z-10 R2\nX30\nG80\nM30\n");
  const auto holes = places.of("G54");
  REQUIRE(holes.size() >= 32);
  CHECK(holes.front().p_mm == Vector3(10, 20, 2));
  std::size_t in_second = 0;
  for (const PathPlace& place : holes) in_second += place.p_mm.x() == 30;
  CHECK(in_second * 2 >= holes.size() - 1);
  CHECK(holes.back().p_mm.z() < -9);
}

TEST_CASE("places do not depend on how the program is cut into windows") {
  std::string text = "G21 G90 G54\nG0 X0 Y0 Z0\nG1 F600\n";
  for (int i = 1; i < 400; ++i) text += fmt::format("G1 X{} Y{}\n", (i * 7) % 90, (i * 5) % 40);
  const Program whole = read_program(text, "part.ngc", {});
  PathPlaces at_once, in_parts;
  at_once.add(whole);
  for (std::size_t begin = 0; begin < whole.moves.size(); begin += 37) {
    Program window = whole;
    const auto first = whole.moves.begin() + static_cast<std::ptrdiff_t>(begin);
    window.moves.assign(
        first, first + static_cast<std::ptrdiff_t>(std::min<std::size_t>(37, whole.moves.size() - begin)));
    in_parts.add(window);
  }
  const auto a = at_once.of("G54"), b = in_parts.of("G54");
  REQUIRE(a.size() == b.size());
  for (std::size_t k = 0; k < a.size(); ++k) CHECK(a[k].p_mm == b[k].p_mm);
}

TEST_CASE("the common shift is the mean deviation of the unloaded machine along the path") {
  const Machine machine = load_machine(orthoglide_b);
  const std::string text = "G21 G90\nG0 X20. Y-40. Z10.\nG1 X60. F300\nG1 Y40.\nM30\n";
  const Shop shop({.machine = machine, .text = text});
  const PathPlaces places = places_of(text);
  const auto shift = common_shift(shop.model, Pose{}, places.of(""));
  REQUIRE(shift);
  Vector3 sum = Vector3::Zero();
  for (const PathPlace& place : places.of("")) {
    const Vector3 p = place.p_mm * mm;
    sum += cold_tip(shop, p, Vector6::Zero()) - p;
  }
  CHECK((*shift - sum / static_cast<double>(places.of("").size())).norm() < 1e-9);
  CHECK(shift->norm() > 0.1e-3);
}

TEST_CASE(
    "a datum that is touched off where the deviation is the common shift leaves the rest that the report "
    "states") {
  const Machine machine = load_machine(orthoglide_b);
  const std::string text = "G21 G90\nG0 X-20. Y-40. Z10.\nG1 X20. F300\nM30\n";
  const Shop plain({.machine = machine, .text = text});
  const Vector3 shift = *common_shift(plain.model, Pose{}, places_of(text).of(""));
  const Vector3 middle = Vector3(0, -40, 10) * mm;
  const Shop touched(
      {.machine = machine, .text = text, .datum_shift = cold_tip(plain, middle, Vector6::Zero()) - middle});
  double rest = 0, before = 0, all = 0;
  for (const Waypoint& w : compensated(plain).waypoints) {
    if (w.between || !w.cutting) continue;
    rest = std::max(rest, (w.before.head<3>() - shift).norm());
    all = std::max(all, w.before.head<3>().norm());
  }
  for (const Waypoint& w : compensated(touched).waypoints)
    if (!w.between && w.cutting) before = std::max(before, w.before.head<3>().norm());
  CHECK(all > 2 * rest);
  CHECK(before == doctest::Approx(rest).epsilon(0.1));
}

TEST_CASE("a path that the machine does not reach has no common shift") {
  const Shop shop({.machine = load_machine(orthoglide_b), .text = "G21 G90\nM30\n"});
  const PathPlaces places = places_of("G21 G90\nG0 X9000. Y0. Z0.\nG1 X9001. F300\nM30\n");
  REQUIRE_FALSE(places.of("").empty());
  CHECK_FALSE(common_shift(shop.model, Pose{}, places.of("")));
}

TEST_CASE("the common shift is that of the places before the first one out of reach") {
  const Shop shop({.machine = load_machine(orthoglide_b), .text = "G21 G90\nM30\n"});
  const std::vector<PathPlace> places{{{10, 0, 0}}, {{0, 20, 0}}, {{9000, 0, 0}}, {{0, 0, 30}}};
  const auto reached = common_shift(shop.model, Pose{}, std::span(places).first(2));
  const auto all = common_shift(shop.model, Pose{}, places);
  REQUIRE(reached);
  REQUIRE(all);
  CHECK(*all == *reached);
}
