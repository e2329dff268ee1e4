// A cursor makes the reading of forces quicker, and changes nothing that is read.
#include <doctest/doctest.h>

#include <random>
#include <string>

#include "forces/sample_path.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("a cursor from anywhere reads the same wrenches and breaks") {
  const std::size_t count = 60;
  std::string rows = "line,fx_N,fy_N,fz_N\n";
  for (std::size_t i = 1; i <= count; ++i)
    rows += std::to_string(i) + "," + std::to_string(i * i % 17) + ",-3," + std::to_string(i % 5) + "\n";
  std::mt19937 random(11);
  for (const double blend : {0.0, 0.3 * mm, 2 * mm, 7.1 * mm})
    for (const std::string& manner : {on_tool, linear}) {
      const auto forces = forces_on(straight(static_cast<double>(count), 1), from_csv(manner + rows, blend));
      ForceCursor cursor;
      std::vector<double> breaks;
      const auto check = [&](std::size_t segment, double u) {
        CAPTURE(blend);
        CAPTURE(segment);
        CAPTURE(u);
        for (const Side side : {Side::before, Side::after})
          CHECK(forces.at(segment, u, side, cursor) == forces.at(segment, u, side));
        forces.breaks(segment, cursor, breaks);
        CHECK(breaks == forces.breaks(segment));
      };
      for (std::size_t i = 0; i < count; ++i)
        for (const double u : {0.0, 0.3, 0.5, 1.0}) check(i, u);
      for (int k = 0; k < 200; ++k) check(random() % count, static_cast<double>(random() % 11) / 10);
    }
}
