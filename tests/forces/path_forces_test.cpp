#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "forces/sample_path.hpp"

using namespace counterflex;
using test::constant;
using test::forces_on;
using test::from_csv;
using test::linear;
using test::near;
using test::on_tool;
using test::ProgramBuilder;
using test::sample_program;
using test::straight;
using test::wrench;

TEST_CASE("rapids carry no force, feed moves the constant one, scaled") {
  ForceSource source = constant(wrench(1, 2, 3, 4, 5, 6), 0);
  source.scale = 0.5;
  const auto forces = forces_on(sample_program(), source);
  for (const double f : {0.0, 0.4, 1.0}) {
    CHECK(forces.at(0, f) == Vector6::Zero());
    CHECK(forces.at(1, f) == wrench(0.5, 1, 1.5, 2, 2.5, 3));
    CHECK(forces.at(3, f) == Vector6::Zero());
    CHECK(forces.at(5, f) == wrench(0.5, 1, 1.5, 2, 2.5, 3));
  }
  CHECK_FALSE(forces.at_platform());
}

TEST_CASE("the program's comments are modal, zero before the first, and steps act at block ends") {
  ProgramBuilder builder({0, 0, 0});
  builder.feed({1, 0, 0}, 60)
      .with_force(wrench(100, 0, 0, 0, 0, 7000))
      .feed({2, 0, 0}, 60)
      .feed({3, 0, 0}, 60);
  builder.with_force(Vector6::Zero()).feed({4, 0, 0}, 60);
  ForceSource source;
  source.blend = 0;
  const auto forces = forces_on(builder.program, source);
  CHECK(forces.at(0, 1) == Vector6::Zero());
  CHECK(forces.at(0, 1, Side::after) == Vector6::Zero());
  CHECK(forces.at(1, 0) == wrench(100, 0, 0, 0, 0, 7000));
  CHECK(forces.at(1, 0, Side::before) == wrench(100, 0, 0, 0, 0, 7000));
  CHECK(forces.at(2, 1) == wrench(100, 0, 0, 0, 0, 7000));
  CHECK(forces.at(3, 0) == Vector6::Zero());
  CHECK(forces.jumps() == 2);
  CHECK(forces.ramps() == 0);
  CHECK(forces.largest_step_N() == 100);
  for (std::size_t i = 0; i < 4; ++i) CHECK(forces.breaks(i).empty());
}

TEST_CASE("a constant force rises over the blend after each rapid and then stays exactly itself") {
  const auto forces = forces_on(sample_program(), constant(wrench(200, 0, -40), 2 * mm));
  for (const std::size_t first : {1u, 4u}) {
    CHECK(forces.at(first, 0) == Vector6::Zero());
    CHECK(near(forces.at(first, 0.05), wrench(50, 0, -10)));
    CHECK(near(forces.at(first, 0.2), wrench(200, 0, -40)));
    CHECK(forces.at(first, 0.7) == wrench(200, 0, -40));
    CHECK(forces.at(first + 1, 0) == wrench(200, 0, -40));
    CHECK(forces.at(first + 1, 1) == wrench(200, 0, -40));
    REQUIRE(forces.breaks(first).size() == 1);
    CHECK(forces.breaks(first)[0] == doctest::Approx(0.2));
    CHECK(forces.breaks(first + 1).empty());
  }
  CHECK(forces.ramps() == 2);
  CHECK(forces.jumps() == 0);
  CHECK(forces.largest_step_N() == doctest::Approx(std::hypot(200, 40)));
}

TEST_CASE("the blend is at most half of the feed run") {
  const auto forces = forces_on(straight(3, 1), constant(wrench(10, 0, 0), 2 * mm));
  CHECK(near(forces.at(0, 0.75), wrench(5, 0, 0)));
  CHECK(near(forces.at(1, 0.5), wrench(10, 0, 0)));
  CHECK(near(forces.at(2, 1), wrench(10, 0, 0)));
}

TEST_CASE("the wrench does not depend on how a cut is divided into blocks") {
  const std::string rows = "s_mm,fx_N,fy_N,fz_N\n0,10,0,0\n3.3,200,5,0\n7.7,-40,0,9\n10,0,0,0\n";
  for (const auto& header : {on_tool, linear}) {
    const auto coarse = forces_on(straight(10, 10), from_csv(header + rows, 2 * mm));
    const auto fine = forces_on(straight(10, 0.1), from_csv(header + rows, 2 * mm));
    for (std::size_t i = 0; i < 100; ++i)
      for (const double f : {0.0, 0.3, 1.0}) {
        CAPTURE(i);
        CHECK(near(fine.at(i, f), coarse.at(0, (static_cast<double>(i) + f) / 100), 1e-8));
      }
    CHECK(fine.ramps() == coarse.ramps());
  }
}

TEST_CASE("the blended wrench is the mean of the unblended one over the last stretch of the run") {
  const std::string rows = "t_s,fx_N,fy_N,fz_N\n0,10,0,0\n0.33,200,5,0\n0.91,-40,0,9\n2,0,0,0\n";
  for (const auto& header : {on_tool, linear}) {
    const Program program = straight(20, 4);
    const auto plain = forces_on(program, from_csv(header + rows)),
               blended = forces_on(program, from_csv(header + rows, 3 * mm));
    const auto unblended = [&](double s_mm) {
      const auto i = std::min<std::size_t>(static_cast<std::size_t>(s_mm / 4), 4);
      return plain.at(i, s_mm / 4 - static_cast<double>(i));
    };
    for (const double s_mm : {0.5, 2.9, 3.1, 4.7, 9.9, 10.3, 19.0}) {
      CAPTURE(s_mm);
      Vector6 sum = Vector6::Zero();
      const int n = 30000;
      for (int k = 0; k < n; ++k) {
        const double u = s_mm - 3 + 3 * (k + 0.5) / n;
        if (u > 0) sum += unblended(u) / n;
      }
      const auto i = static_cast<std::size_t>(s_mm / 4);
      CHECK(near(blended.at(i, s_mm / 4 - static_cast<double>(i)), sum, 0.02));
    }
  }
}

TEST_CASE("a step inside a segment has two sides, and a break at its place") {
  const auto forces =
      forces_on(straight(10, 10), from_csv(on_tool + "s_mm,fx_N,fy_N,fz_N\n0,1,0,0\n3,2,0,0\n7,3,0,0\n"));
  const auto breaks = forces.breaks(0);
  REQUIRE(breaks.size() == 2);
  CHECK(breaks[0] == doctest::Approx(0.3));
  CHECK(breaks[1] == doctest::Approx(0.7));
  for (int i = 0; i < 2; ++i) {
    CHECK(forces.at(0, breaks[i], Side::before) == wrench(i + 1, 0, 0));
    CHECK(forces.at(0, breaks[i], Side::after) == wrench(i + 2, 0, 0));
  }
  CHECK(forces.at(0, 0, Side::before) == wrench(1, 0, 0));
  CHECK(forces.at(0, 1, Side::after) == wrench(3, 0, 0));
}

TEST_CASE("the two sides of every break are those of its step, for any rounding of its place") {
  std::string text = on_tool + "s_mm,fx_N,fy_N,fz_N\n0,0,0,0\n";
  for (int i = 1; i <= 120; ++i) text += std::to_string(0.7123 * i) + "," + std::to_string(i) + ",0,0\n";
  for (const double block_mm : {9.1, 91.0}) {
    const auto path = build_toolpath(straight(91, block_mm), {{}});
    const auto forces = forces_on(straight(91, block_mm), from_csv(text));
    int steps = 0;
    for (std::size_t i = 0; i < path.segments.size(); ++i)
      for (const double f : forces.breaks(i)) {
        CAPTURE(f);
        for (const double off : {-1e-13, 0.0, 1e-13}) {
          CHECK(forces.at(i, f + off, Side::before)[0] == steps);
          CHECK(forces.at(i, f + off, Side::after)[0] == steps + 1);
        }
        ++steps;
      }
    CHECK(steps == 120);
  }
}

TEST_CASE("between breaks the blended wrench of a stepped profile is a straight line") {
  const auto forces = forces_on(
      straight(12, 6),
      from_csv(on_tool + "s_mm,fx_N,fy_N,fz_N\n0,1,0,0\n3.2,20,0,5\n4.1,-7,0,0\n5,9,1,1\n", 2 * mm));
  for (const std::size_t i : {0u, 1u}) {
    auto knots = forces.breaks(i);
    knots.insert(knots.begin(), 0);
    knots.push_back(1);
    for (std::size_t k = 0; k + 1 < knots.size(); ++k)
      for (const double w : {0.2, 0.5, 0.9}) {
        const Vector6 chord = (1 - w) * forces.at(i, knots[k]) + w * forces.at(i, knots[k + 1]);
        CHECK(near(forces.at(i, (1 - w) * knots[k] + w * knots[k + 1]), chord, 1e-7));
      }
  }
  CHECK(forces.ramps() == 4);
}

TEST_CASE("a rapid without a segment also ends a feed run") {
  ProgramBuilder builder({0, 0, 0});
  builder.feed({10, 0, 0}, 600).rapid({10, 0, 9}).rapid({10, 0, 0}).feed({20, 0, 0}, 600);
  builder.program.moves[1].known_end[2] = builder.program.moves[2].known_start[2] = false;
  const auto forces = forces_on(builder.program, constant(wrench(10, 0, 0), 2 * mm));
  CHECK(near(forces.at(0, 1), wrench(10, 0, 0)));
  CHECK(forces.at(1, 0) == Vector6::Zero());
  CHECK(forces.ramps() == 2);
}

TEST_CASE("cuts that do not join are not one run") {
  ProgramBuilder builder({0, 0, 0});
  builder.feed({10, 0, 0}, 600);
  builder.at_mm = {0, 5, 0};
  builder.feed({10, 5, 0}, 600);
  const auto forces = forces_on(builder.program, constant(wrench(10, 0, 0), 2 * mm));
  CHECK(forces.at(1, 0) == Vector6::Zero());
}

TEST_CASE("a profile can act at the platform, a constant force acts at the tip") {
  auto source = from_csv(on_tool + "# at = platform\nline,fx_N,fy_N,fz_N\n1,1,0,0\n");
  CHECK(forces_on(sample_program(), source).at_platform());
  CHECK_FALSE(forces_on(sample_program(), constant(wrench(1, 0, 0), 0)).at_platform());
}

TEST_CASE("very long runs keep the blended wrench accurate") {
  const std::size_t count = 200000;
  const Program program = straight(100.0 * count, 100);
  std::string text = on_tool + "line,fx_N,fy_N,fz_N\n";
  for (std::size_t i = 1; i <= count; ++i)
    text += std::to_string(i) + (i % 2 == 0 ? ",300,0,0\n" : ",200,0,0\n");
  const auto forces = forces_on(program, from_csv(text, 2 * mm));
  CHECK(forces.ramps() == count);
  CHECK(near(forces.at(count - 1, 0.01), wrench(250, 0, 0), 1e-3));
  CHECK(forces.at(count - 1, 0.5) == wrench(300, 0, 0));
  CHECK(forces.breaks(count - 1).size() == 1);
}

TEST_CASE("feed moves wholly above the air height carry no force, other moves are unchanged") {
  ForceSource source = constant(wrench(100, 0, 0), 0);
  source.air_above_mm = 4.9;
  const auto forces = forces_on(sample_program(), source);  // cuts from Z10 to Z0, in Z0, and twice in Z5
  CHECK(forces.at(1, 0.1) == wrench(100, 0, 0));
  CHECK(forces.at(2, 0.5) == wrench(100, 0, 0));
  for (const std::size_t i : {4u, 5u}) CHECK(forces.at(i, 0.5) == Vector6::Zero());
  source.air_above_mm = 5;
  CHECK(forces_on(sample_program(), source).at(4, 0.5) == wrench(100, 0, 0));
  auto profile = from_csv(on_tool + "line,fx_N,fy_N,fz_N\n1,1,0,0\n");
  profile.air_above_mm = 4.9;
  CHECK(forces_on(sample_program(), profile).at(2, 0.5) == wrench(1, 0, 0));
  CHECK(forces_on(sample_program(), profile).at(4, 0.5) == Vector6::Zero());
}

TEST_CASE("an upright arc is in the air only where its lowest point is") {
  // counter-clockwise about Y from -X to X: over the top
  const Program program = ProgramBuilder({-10, 0, 0}).feed({10, 0, 0}, 600).about({0, 0, 0}, 1).program;
  const double lowest = extent_of(program.moves[0]).least.z();
  CHECK(lowest == 0);
  ForceSource source = constant(wrench(100, 0, 0), 0);
  source.air_above_mm = lowest - 1e-6;
  CHECK(forces_on(program, source).at(0, 0.5) == Vector6::Zero());
  source.air_above_mm = lowest + 1e-6;
  CHECK(forces_on(program, source).at(0, 0.5) == wrench(100, 0, 0));
}

TEST_CASE("the mean of a linear profile is nowhere larger than at breaks and ends, by what reports show") {
  std::mt19937 random(7);
  const auto number = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  double largest = 0;
  for (int trial = 0; trial < 60; ++trial) {
    CAPTURE(trial);
    const double blend = number(0.1, 5);
    std::string rows = "s_mm,fx_N,fy_N,fz_N\n";
    double s = 0;
    while (s < 60) {
      rows += fmt::format("{},{},{},{}\n", s, number(-900, 900), number(-900, 900), trial % 3 == 0 ? 7 : s);
      s += number(0.05, trial % 2 == 0 ? 3 : 30);
    }
    rows += "60,0,0,0\n";
    const double length = trial % 4 == 0 ? 1 : 20;
    const auto forces = forces_on(straight(60, length), from_csv(linear + rows, blend * mm));
    for (std::size_t i = 0; i < static_cast<std::size_t>(60 / length); ++i) {
      Vector6 most = forces.at(i, 0).cwiseMax(forces.at(i, 1)),
              least = forces.at(i, 0).cwiseMin(forces.at(i, 1));
      double last = 0;
      for (const double u : forces.breaks(i)) {
        CHECK(u > last);
        last = u;
        most = most.cwiseMax(forces.at(i, u)), least = least.cwiseMin(forces.at(i, u));
      }
      for (int k = 1; k < 1000; ++k) {
        const Vector6 F = forces.at(i, k / 1000.0);
        largest = std::max({largest, (F - most).maxCoeff(), (least - F).maxCoeff()});
      }
    }
  }
  CHECK(largest > 0);
  CHECK(largest < 0.0501);
}

TEST_CASE("with a blend a peak between two slopes of a profile has breaks, and a constant has none") {
  const auto peak = forces_on(
      straight(640, 640),
      from_csv(linear + "s_mm,fx_N,fy_N,fz_N\n0,0,0,0\n100,0,0,0\n101,0,3000,0\n102,0,0,0\n640,0,0,0\n",
               2 * mm));
  std::vector<double> places = peak.breaks(0);
  for (double& u : places) u *= 640;
  REQUIRE(places.size() == 5);
  for (std::size_t i = 0; i < 5; ++i) CHECK(places[i] == doctest::Approx(100 + static_cast<double>(i)));
  CHECK(near(peak.at(0, 102.0 / 640), wrench(0, 1500, 0)));
  const auto constant =
      forces_on(straight(10, 1),
                from_csv(linear + "s_mm,fx_N,fy_N,fz_N\n0,0.1,0,0\n3.3,0.1,0,0\n10,0.1,0,0\n", 2 * mm));
  for (std::size_t i = 2; i < 10; ++i) CHECK(constant.breaks(i).empty());
}
