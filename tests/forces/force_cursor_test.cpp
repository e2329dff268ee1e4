// A cursor makes the reading of forces faster and does not change the results.
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

TEST_CASE("where a segment follows another in its feed run the start has the wrench of the end before it") {
  const std::string rows = "line,fx_N,fy_N,fz_N\n1,10,0,0\n3,15,0,0\n5,20,0,0\n";
  for (const double blend : {0.0, 2 * mm}) {
    const auto forces = forces_on(sample_program(), from_csv(on_tool + rows, blend));
    for (std::size_t i = 0; i < 6; ++i) {
      CAPTURE(i);
      const bool joins = i == 2 || i == 5;  // the others are rapids, or follow them
      CHECK(forces.follows(i) == (joins && blend > 0));
      CHECK(forces.begins_with_step(i) == (i == 2 && blend == 0));
      if (forces.follows(i)) CHECK(forces.at(i, 0) == forces.at(i - 1, 1));
    }
  }
}

TEST_CASE("the wrench is linear between breaks where a profile has steps, and not where it has slopes") {
  const std::string rows = "s_mm,fx_N,fy_N,fz_N\n0,10,0,0\n1,50,0,0\n2,10,0,0\n4,10,0,0\n";
  for (const std::string& manner : {on_tool, linear}) {
    const auto forces = forces_on(straight(4, 1), from_csv(manner + rows, 0.4 * mm));
    double largest = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      std::vector<double> ends = forces.breaks(i);
      ends.insert(ends.begin(), 0);
      ends.push_back(1);
      for (std::size_t k = 1; k < ends.size(); ++k) {
        const Vector6 chord = (forces.at(i, ends[k - 1]) + forces.at(i, ends[k])) / 2;
        largest = std::max(largest, (forces.at(i, (ends[k - 1] + ends[k]) / 2) - chord).norm());
      }
    }
    CHECK(forces.is_linear_between_breaks() == (manner == on_tool));
    CHECK((largest < 1e-9) == forces.is_linear_between_breaks());
  }
}
