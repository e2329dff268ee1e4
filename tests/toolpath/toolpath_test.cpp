#include "counterflex/toolpath/toolpath.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "counterflex/geometry/types.hpp"
#include "counterflex/toolpath/reach.hpp"
#include "support/programs.hpp"

using namespace counterflex;
using test::ProgramBuilder;

TEST_CASE("path length and time count feed moves only") {
  const Program program = ProgramBuilder({0, 0, 5})
                              .rapid({10, 0, 5})
                              .feed({10, 0, -1}, 60)
                              .feed({13, 4, -1}, 300)
                              .rapid({13, 4, 5})
                              .feed({13, 4, 4}, 300)
                              .program;
  const auto segments = build_toolpath(program, one_frame(program, {})).segments;
  REQUIRE(segments.size() == 5);
  CHECK_FALSE(segments[0].cutting);
  CHECK(segments[0].s_end == 0);
  CHECK(segments[0].t_end == 0);
  CHECK(segments[1].s_end == doctest::Approx(0.006));
  CHECK(segments[1].t_end == doctest::Approx(6));
  CHECK(segments[2].s_end == doctest::Approx(0.011));
  CHECK(segments[2].t_end == doctest::Approx(7));
  CHECK(segments[2].feed_m_s == doctest::Approx(0.005));
  CHECK(segments[3].s_start == segments[2].s_end);
  CHECK(segments[3].s_end == segments[2].s_end);
  CHECK(segments[4].s_start == segments[3].s_end);
  CHECK(segments[4].t_end == doctest::Approx(7.2));
}

TEST_CASE("the work frame places program coordinates in the machine") {
  const Program program = ProgramBuilder({0, 0, 0}).feed({100, 0, 0}, 600).program;
  const Pose X_MW{exp_so3({0, 0, 90 * deg}), {1, 2, 3}};
  const auto path = build_toolpath(program, one_frame(program, {{}, X_MW}));
  REQUIRE(path.segments.size() == 1);
  const Segment& segment = path.segments[0];
  CHECK((segment.wanted.start - Vector3(1, 2, 3)).norm() < 1e-15);
  CHECK((segment.wanted.end - Vector3(1, 2.1, 3)).norm() < 1e-15);
  CHECK(path.frames[segment.frame].X_MW.p == X_MW.p);
}

TEST_CASE("moves that start or end at an unknown place have no segment") {
  ProgramBuilder builder({0, 0, 0});
  builder.rapid({0, 0, 5}).feed({0, 0, 1}, 100).feed({0, 0, 0}, 100);
  builder.program.moves[0].known_start = {true, true, false};
  builder.program.moves[2].known_end = {false, true, true};
  const auto segments = build_toolpath(builder.program, one_frame(builder.program, {})).segments;
  REQUIRE(segments.size() == 1);
  CHECK(segments[0].move == 1);
  CHECK(segments[0].line == builder.program.moves[1].line);
  CHECK(segments[0].s_start == 0);
}

TEST_CASE("a move without length has no segment and keeps the path joined") {
  const Program program =
      ProgramBuilder({0, 0, 0}).feed({1, 0, 0}, 60).feed({1, 0, 0}, 60).feed({2, 0, 0}, 60).program;
  const auto segments = build_toolpath(program, one_frame(program, {})).segments;
  REQUIRE(segments.size() == 2);
  CHECK(segments[1].move == 2);
  CHECK(segments[1].s_start == segments[0].s_end);
}

TEST_CASE("without a programmed feed the length increases, the time does not") {
  const auto segments = build_toolpath(ProgramBuilder({0, 0, 0}).feed({1, 0, 0}, 0).program, {{}}).segments;
  REQUIRE(segments.size() == 1);
  CHECK(segments[0].feed_m_s == 0);
  CHECK(segments[0].t_end == 0);
  CHECK(segments[0].s_end == doctest::Approx(0.001));
}

TEST_CASE("an ignored axis is always known and does not move before it is programmed") {
  Program program =
      ProgramBuilder({0, 0, 0}).rapid({10, 0, 0}).rapid({10, 0, 5}).feed({20, 0, 5}, 100).program;
  for (std::size_t m = 0; m < 2; ++m) program.moves[m].known_start[2] = false;
  program.moves[0].known_end[2] = false;
  ignore_axes(program, {false, false, true});
  for (const Move& move : program.moves) {
    CHECK(move.ignored[2]);
    CHECK_FALSE(move.ignored[0]);
    CHECK(move.known_start[2]);
    CHECK(move.start_mm.z() == 5);
    CHECK(move.end_mm.z() == 5);
  }
  CHECK(build_toolpath(program, one_frame(program, {})).segments.size() ==
        2);  // a move of Z only has no length
}

TEST_CASE("arcs and helices count with their own length, in path and time") {
  const Program program = ProgramBuilder({10, 0, 0})
                              .arc({0, 10, 0}, {0, 0, 0}, 600)
                              .arc({0, 10, 0}, {0, 0, 0}, 600, true)
                              .arc({0, -10, 5}, {0, 0, 0}, 300)
                              .program;
  const auto segments = build_toolpath(program, one_frame(program, {})).segments;
  REQUIRE(segments.size() == 3);
  const double quarter = 0.01 * 90 * deg, half_helix = std::hypot(2 * quarter, 0.005);
  CHECK(segments[0].s_end == doctest::Approx(quarter));
  CHECK(segments[0].t_end == doctest::Approx(quarter / 0.01));
  CHECK(segments[1].s_end == doctest::Approx(5 * quarter));  // the whole circle
  CHECK(segments[2].s_end == doctest::Approx(5 * quarter + half_helix));
  CHECK(segments[2].t_end == doctest::Approx(5 * quarter / 0.01 + half_helix / 0.005));
}

TEST_CASE("under G93 a move takes 1/F minutes for any length, which defines its feed") {
  Program program = ProgramBuilder({10, 0, 0}).feed({0, 0, 0}, 600).feed({0, 30, 0}, 600).program;
  for (Move& move : program.moves) {
    move.feed_mode = FeedMode::inverse_time;
    move.feed_per_min = 30;
  }
  const auto segments = build_toolpath(program, one_frame(program, {})).segments;
  CHECK(segments[0].t_end == doctest::Approx(2));
  CHECK(segments[1].t_end == doctest::Approx(4));
  CHECK(segments[0].feed_m_s == doctest::Approx(0.005));
  CHECK(segments[1].feed_m_s == doctest::Approx(0.015));
}

TEST_CASE("the extent of an arc holds its outermost points, of a line its ends") {
  const Program program = ProgramBuilder({10, 0, 0})
                              .arc({0, -10, 3}, {0, 0, 0}, 600)
                              .feed({5, 5, -1}, 600)
                              .feed({5, 5, -1}, 600)
                              .about({5, 5, -11}, 0)
                              .program;
  const Extent helix = extent_of(program.moves[0]);  // three quarters
  CHECK((helix.least - Vector3(-10, -10, 0)).norm() < 1e-12);
  CHECK((helix.most - Vector3(10, 10, 3)).norm() < 1e-12);
  const Extent line = extent_of(program.moves[1]);
  CHECK(line.least == Vector3(0, -10, -1));
  CHECK(line.most == Vector3(5, 5, 3));
  const Extent circle = extent_of(program.moves[2]);  // G19
  CHECK((circle.least - Vector3(5, -5, -21)).norm() < 1e-12);
  CHECK((circle.most - Vector3(5, 15, -1)).norm() < 1e-12);
}

TEST_CASE("points along an arc are on it, near to each other, from its start to its end") {
  const Program program =
      ProgramBuilder({10, 0, 0}).arc({0, -10, 0}, {0, 0, 0}, 600).feed({1, 1, 1}, 600).program;
  const auto points = points_along(curve_of(program.moves[0]));
  CHECK(points.front() == program.moves[0].start_mm);
  CHECK(points.back() == program.moves[0].end_mm);
  for (std::size_t i = 1; i < points.size(); ++i) {
    CHECK(points[i].norm() == doctest::Approx(10));
    CHECK((points[i] - points[i - 1]).norm() < 10 * 22.5 * deg);
  }
  CHECK(points_along(curve_of(program.moves[1])).size() == 2);
}

TEST_CASE("an arc in a turned frame goes nowhere beyond the points along it") {
  const Program program = ProgramBuilder({10, 0, 0}).arc({0, -10, 0}, {0, 0, 0}, 600).program;
  for (const double angle : {0.0, 10 * deg, 100 * deg}) {
    CAPTURE(angle);
    const Pose X_AP{exp_so3(Vector3(0.5, -0.7, angle)), Vector3(1, 2, 3)};
    const Curve curve = X_AP * curve_of(program.moves[0]);
    const Extent extent = extent_of(curve);
    Vector3 least = curve.start, most = curve.start;
    for (int i = 0; i <= 10000; ++i) {
      least = least.cwiseMin(point_at(curve, 1e-4 * i));
      most = most.cwiseMax(point_at(curve, 1e-4 * i));
    }
    CHECK((least - extent.least).cwiseAbs().maxCoeff() < 1e-6);
    CHECK((most - extent.most).cwiseAbs().maxCoeff() < 1e-6);
  }
}

TEST_CASE("under G91 each repeat of a cycle drills at its own place, under G90 all drill at one") {
  Program program = ProgramBuilder({0, 10, 5}).rapid({30, 40, 5}).program;
  Move& move = program.moves[0];
  move.cycle.emplace().bottom_mm = -30;
  move.cycle->repeats = 3;
  CHECK(count_of_holes(move) == 1);
  CHECK(fractions_of_holes(move) == std::vector<double>{1});
  move.relative = true;
  CHECK(count_of_holes(move) == 3);
  const std::vector<Curve> holes = holes_of_cycle(move);
  REQUIRE(holes.size() == 3);
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    CHECK((holes[k].end - Vector3(10 * (i + 1), 10 * (i + 2), -30)).norm() < 1e-12);
  }
  CHECK(holes[2].end == Vector3(30, 40, -30));
  CHECK(places_of_cycle(move).size() == 6);
  move.known_end[0] = false;
  CHECK(fractions_of_holes(move).empty());
  CHECK(goes_to_unknown_places(move));
}

TEST_CASE("a hole is known from where its feed begins to its bottom, if place and depth are") {
  Program program = ProgramBuilder({0, 0, 5}).rapid({10, 20, 0}).program;
  Move& move = program.moves[0];
  CHECK(holes_of_cycle(move).empty());
  CHECK_FALSE(goes_to_unknown_places(move));
  SUBCASE("of a cycle in the block") {
    move.cycle.emplace().bottom_mm = -30;
    move.cycle->retract_mm = 2;
    move.known_end[2] = false;
    const std::vector<Curve> holes = holes_of_cycle(move);
    REQUIRE(holes.size() == 1);
    CHECK(holes[0].start == Vector3(10, 20, 2));
    CHECK(holes[0].end == Vector3(10, 20, -30));
    CHECK(places_of_cycle(move) == std::vector{Vector3(10, 20, -30), Vector3(10, 20, 2)});
    move.cycle->repeats = 0;
    CHECK(holes_of_cycle(move).empty());
    CHECK_FALSE(goes_to_unknown_places(move));
  }
  SUBCASE("of a cycle that is called") {
    move.makes_hole = true;
    move.called.emplace().heights_mm = {0, 5, -30, 0};
    const std::vector<Curve> holes = holes_of_cycle(move);
    REQUIRE(holes.size() == 1);
    CHECK(holes[0].start == Vector3(10, 20, 0));
    CHECK(holes[0].end == Vector3(10, 20, -30));
    CHECK(places_of_cycle(move) == std::vector{Vector3(10, 20, -30), Vector3(10, 20, 5)});
    move.called->heights_mm[2] = std::nan("");
    CHECK(holes_of_cycle(move).empty());
    CHECK(goes_to_unknown_places(move));
  }
  SUBCASE("not of one that mills around its place, or of a position that is a variable") {
    move.mills_at_end = true;
    CHECK(holes_of_cycle(move).empty());
    CHECK(goes_to_unknown_places(move));
    move.mills_at_end = false;
    move.fixed[0] = true;
    CHECK(goes_to_unknown_places(move));
  }
}
