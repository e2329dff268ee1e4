#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <random>

#include "forces/sample_path.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const std::string header = on_tool + "x_mm,y_mm,z_mm,fx_N,fy_N,fz_N\n";

/// One row each: point in mm and fx.
using Log = std::vector<std::pair<Vector3, double>>;

ForceSource logged(const Log& rows, const std::string& settings = "") {
  std::string text = settings + header;
  for (const auto& [p, fx] : rows) text += fmt::format("{},{},{},{},0,0\n", p.x(), p.y(), p.z(), fx);
  ForceSource source;
  source.blend = 0;
  source.rules = read_force_csv(text, "log.csv");
  return source;
}

std::string refused_log(const Program& program, const ForceSource& source) {
  try {
    forces_on(program, source);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// Path lengths of the rows, mm, after the log was matched with the path.
std::vector<double> places_mm(const Program& program, ForceSource source) {
  source.rules.push_back(parse_force_rule("0,0,0"));  // for moves without a row
  const Toolpath path = build_toolpath(program, one_frame(program, {}));
  ForceCover cover(source);
  while (cover.needs_pass()) {
    cover.add(program, path);
    cover.end_pass();
  }
  std::vector<double> s;
  for (const ForceRow& row : std::get<ForceProfile>(source.rules[0].content).rows) s.push_back(row.key / mm);
  return s;
}

void check_places(const std::vector<double>& s, const std::vector<double>& expected, double to = 1e-6) {
  REQUIRE(s.size() == expected.size());
  for (std::size_t i = 0; i < s.size(); ++i) CHECK(std::abs(s[i] - expected[i]) < to);
}

}  // namespace

TEST_CASE("a row of a log acts from the point of the feed path that is nearest to its position") {
  const auto forces = forces_on(
      sample_program(), logged({{{0, 0.1, 10}, 1}, {{3, 0.5, 0}, 2}, {{10.2, 4, 5}, 3}, {{5, 10, 4.5}, 4}}));
  CHECK(forces.at(1, 0.5)[0] == 1);
  REQUIRE(forces.breaks(2).size() == 1);
  CHECK(forces.breaks(2)[0] == doctest::Approx(0.3));
  CHECK(forces.at(2, 0.31)[0] == 2);
  REQUIRE(forces.breaks(4).size() == 1);
  CHECK(forces.breaks(4)[0] == doctest::Approx(0.4));
  CHECK(forces.at(5, 0.4)[0] == 3);
  CHECK(forces.at(5, 0.6)[0] == 4);
}

TEST_CASE("a position on an arc is found at its place") {
  const Program program = ProgramBuilder({10, 0, 0}).arc({-10, 0, 0}, {0, 0, 0}, 600).program;
  Log log;
  std::vector<double> expected;
  for (const double angle : {0.0, 0.3, 1.7, 2.9}) {
    log.push_back({{10.4 * std::cos(angle), 10.4 * std::sin(angle), 0.2}, 1});
    expected.push_back(10 * angle);
  }
  check_places(places_mm(program, logged(log)), expected, 1e-2);
}

TEST_CASE("passes through the same place are distinguished by the order of the rows") {
  // there and back, and there again
  ProgramBuilder builder({0, 0, 0});
  builder.feed({20, 0, 0}, 600).feed({0, 0, 0}, 600).feed({20, 0, 0}, 600);
  const Log there{{{2, 0, 0}, 1}, {{8, 0, 0}, 2}, {{20, 0, 0}, 3}};
  Log log = there;
  for (const double x : {15.0, 5.0, 0.0, 16.0}) log.push_back({{x, 0, 0}, x});
  check_places(places_mm(builder.program, logged(log)), {2, 8, 20, 25, 35, 40, 56});
  // a spring pass: a rapid brings the tool back to where it began
  ProgramBuilder spring({0, 0, 0});
  spring.feed({20, 0, 0}, 600).rapid({20, 0, 9}).rapid({0, 0, 9}).rapid({0, 0, 0}).feed({20, 0, 0}, 600);
  Log twice = there;
  twice.insert(twice.end(), there.begin(), there.end());
  check_places(places_mm(spring.program, logged(twice)), {2, 8, 20, 22, 28, 40});
  // logged once, it is the first
  check_places(places_mm(spring.program, logged(there)), {2, 8, 20});
}

TEST_CASE("of two passes within the limit a row belongs to the nearer one, if the order allows it") {
  ProgramBuilder builder({0, 0, 0});
  builder.feed({10, 0, 0}, 600).feed({10, 0.5, 0}, 600).feed({0, 0.5, 0}, 600);
  const auto place = [&](double y) { return places_mm(builder.program, logged({{{4, y, 0}, 1}})).front(); };
  CHECK(place(0.1) == doctest::Approx(4));
  CHECK(place(0.4) == doctest::Approx(16.5));
  // the second row cannot be before the first
  check_places(places_mm(builder.program, logged({{{4, 0.45, 0}, 1}, {{3, 0.2, 0}, 2}})), {16.5, 17.5});
}

TEST_CASE("positions that scatter along the path stay in order, and rows at one place have their mean") {
  const Program program = straight(100, 100);
  Log log{{{0, 0, 0}, 0}};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> scatter(-0.2, 0.2);
  for (int i = 1; i <= 900; ++i) log.push_back({{0.1 * i + scatter(random), scatter(random), 0}, 1});
  const std::vector<double> s = places_mm(program, logged(log));
  CHECK(s.size() > 300);
  for (std::size_t i = 1; i < s.size(); ++i) CHECK(s[i] > s[i - 1]);
  CHECK(s.back() == doctest::Approx(90).epsilon(0.01));
  const auto forces =
      forces_on(program, logged({{{0, 0, 0}, 1}, {{50, 0, 0}, 10}, {{50, 0.1, 0}, 20}, {{50, 0, 0.3}, 60}}));
  CHECK(forces.at(0, 0.6)[0] == doctest::Approx(30));
}

TEST_CASE("coordinates are the program's, or those of the machine") {
  const Pose X_MW{exp_so3({0, 0, pi / 2}), {0.1, 0, 0}};
  const Program program = straight(20, 20);
  const Log in_work{{{0, 0, 0}, 1}, {{5, 0, 0}, 2}}, in_machine{{{100, 0, 0}, 1}, {{100, 5, 0}, 2}};
  const auto check = [&](const ForceSource& source) {
    const auto forces = forces_on(program, source, X_MW);
    REQUIRE(forces.breaks(0).size() == 1);
    CHECK(forces.breaks(0)[0] == doctest::Approx(0.25));
  };
  check(logged(in_work));
  check(logged(in_work, "# coordinates = work\n"));
  check(logged(in_machine, "# coordinates = machine\n"));
}

TEST_CASE("within_mm is the limit, and the error for a row beyond it names the nearest line") {
  const Log log{{{0, 0, 0}, 1}, {{5, 2, 0}, 2}};
  const auto program = straight(20, 5);
  CHECK(refused_log(program, logged(log)) ==
        "log.csv:5:1: error: row 2: no feed move comes within 1 mm of x 5, y 2, z 0: the nearest is 2 mm "
        "away, in line 1");
  CHECK(refused_log(program, logged(log, "# within_mm = 1.99\n")).find("within 1.99 mm") !=
        std::string::npos);
  CHECK(refused_log(program, logged(log, "# within_mm = 2.01\n")) == "no error");
}

TEST_CASE("a log may begin and end a limit's length away from the cut, and no further") {
  const auto program = straight(20, 5);
  CHECK(refused_log(program, logged({{{0.9, 0, 0}, 1}})) == "no error");
  CHECK(refused_log(program, logged({{{6.5, 0, 0}, 1}})) ==
        "log.csv:4:1: error: x 6.5, y 0, z 0 is the first row, but the program cuts from 6.5 mm before it on "
        "(line 1): a row there is required, with zeros where nothing is cut");
  CHECK(refused_log(program, logged({{{1.1, 0, 0}, 1}})).find("is the first row") != std::string::npos);
  const std::string linear_log = "# interpolation = linear\n";
  CHECK(refused_log(program, logged({{{0, 0, 0}, 1}, {{19.1, 0, 0}, 1}}, linear_log)) == "no error");
  CHECK(refused_log(program, logged({{{0, 0, 0}, 1}, {{18.9, 0, 0}, 1}}, linear_log)) ==
        "log.csv:6:1: error: x 18.9, y 0, z 0 is the last row, but the program cuts until 1.1 mm behind it "
        "(line 4): a row there is required for linear interpolation");
}

TEST_CASE("a path far beyond the points of a log does not come near them") {
  const Program program = ProgramBuilder({0, 0, 0}).feed({5, 0, 0}, 600).rapid({1e22, 0, 0}).program;
  Program far = program;
  far.moves[1].motion = Motion::feed;
  far.moves[1].start_mm = {1e22, 0, 0};
  far.moves[1].end_mm = {1e22, 2, 0};
  CHECK(refused_log(far, logged({{{0, 0, 0}, 1}})) == "no error");
}

TEST_CASE("a log of a part of the program leaves the rest to other rules") {
  ForceSource source = logged({{{2, 0, 0}, 5}, {{8, 0, 0}, 6}}, "# interpolation = linear\n");
  source.rules.push_back(parse_force_rule("1,0,0"));
  const auto forces = forces_on(sample_program(), source);
  CHECK(forces.at(1, 0.5)[0] == 1);
  CHECK(forces.at(2, 0.05)[0] == 1);
  CHECK(forces.at(2, 0.5)[0] == doctest::Approx(5.5));
  CHECK(forces.at(2, 0.95)[0] == 1);
  CHECK(forces.at(4, 0.5)[0] == 1);
}

TEST_CASE("a place with too many passes is refused, so that memory stays bounded") {
  ProgramBuilder builder({0, 0, 0});
  for (int i = 0; i < 600; ++i) builder.feed({5, 0, 0}, 600).feed({0, 0, 0}, 600);
  CHECK(refused_log(builder.program, logged({{{2, 0, 0}, 1}})).find("more than 1000 times") !=
        std::string::npos);
}

TEST_CASE("rows are found in any window of a program as in the whole") {
  ProgramBuilder builder({0, 0, 0});
  Log log{{{0, 0, 0}, 0}};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> turn(-0.5, 0.5), off(-0.1, 0.1);
  double angle = 0;
  for (int i = 0; i < 400; ++i) {
    angle += turn(random);
    builder.feed(builder.at_mm + 0.7 * Vector3(std::cos(angle), std::sin(angle), 0.1), 600);
    if (i % 5 == 0) log.push_back({builder.at_mm + Vector3(off(random), off(random), off(random)), 1});
  }
  const Program& whole = builder.program;
  const ForceSource source = logged(log);
  const std::vector<double> expected = places_mm(whole, source);
  ForceSource settled = source;
  ForceCover cover(settled);
  while (cover.needs_pass()) {
    PathEnd end;
    for (std::size_t first = 0; first < whole.moves.size(); first += 7) {
      Program window = whole;
      window.moves.assign(whole.moves.begin() + static_cast<long>(first),
                          whole.moves.begin() + static_cast<long>(std::min(first + 7, whole.moves.size())));
      const Toolpath path = build_toolpath(window, one_frame(window, {}), end);
      cover.add(window, path);
      end = path.end;
    }
    cover.end_pass();
  }
  const auto& rows = std::get<ForceProfile>(settled.rules[0].content).rows;
  REQUIRE(rows.size() == expected.size());
  for (std::size_t i = 0; i < rows.size(); ++i) CHECK(rows[i].key / mm == doctest::Approx(expected[i]));
}

TEST_CASE("rows of a raster in steps of 0.1 mm belong to their own pass, though others are in the limit") {
  ProgramBuilder builder({0, 0, 0});
  std::mt19937 random(5);
  std::normal_distribution<double> off(0, 0.03);
  Log log;
  std::vector<double> expected;
  for (int pass = 0; pass < 60; ++pass) {
    const bool there = pass % 2 == 0;
    const double y = 0.1 * pass, begin = 40.1 * pass;
    builder.feed({there ? 0.0 : 40.0, y, 0}, 600).feed({there ? 40.0 : 0.0, y, 0}, 600);
    for (double way = 0.7; way < 40; way += 1.3) {
      log.push_back({{(there ? way : 40 - way) + off(random), y + off(random), off(random)}, way});
      expected.push_back(begin + way);
    }
  }
  const std::vector<double> s = places_mm(builder.program, logged(log));
  REQUIRE(s.size() == expected.size());
  std::size_t astray = 0;
  for (std::size_t i = 0; i < s.size(); ++i) astray += std::abs(s[i] - expected[i]) > 0.2;
  CHECK(astray < s.size() / 50);
}
