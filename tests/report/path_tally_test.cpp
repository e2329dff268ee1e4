#include <doctest/doctest.h>

#include <algorithm>

#include "counterflex/report/run_tally.hpp"
#include "made_up_run.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

PathTally tally_of(const std::vector<Waypoint>& waypoints) {
  PathTally tally;
  for (const Waypoint& w : waypoints) tally.add(w);
  return tally;
}

constexpr int many_lines = 20000;

/// Values without an order, some of them equal.
WorstRow scattered_row(int line) {
  return {line, 1e-4 * (line * 7919 % 10007), 1e-4 * line * (line * 6101 % 9973)};
}

}  // namespace

TEST_CASE("the worst of many thousand lines are found for any order of values") {
  WorstLines lines;
  std::vector<WorstRow> all;
  for (int line = 1; line <= many_lines; ++line) {
    all.push_back(scattered_row(line));
    lines.row(line).after_mm = all.back().after_mm;
    // the deviation before is known when the next piece begins
    if (line > 1) lines.row(line - 1).before_mm = scattered_row(line - 1).before_mm;
  }
  lines.row(many_lines).before_mm = all.back().before_mm;
  for (const auto key : {&WorstRow::before_mm, &WorstRow::after_mm}) {
    std::vector<WorstRow> expected = all;
    std::stable_sort(expected.begin(), expected.end(),
                     [&](const WorstRow& a, const WorstRow& b) { return a.*key > b.*key; });
    const std::vector<WorstRow> worst = lines.worst(key);
    REQUIRE(worst.size() == 10);
    for (std::size_t i = 0; i < worst.size(); ++i) {
      CHECK(worst[i].line == expected[i].line);
      CHECK(worst[i].before_mm == expected[i].before_mm);
      CHECK(worst[i].after_mm == expected[i].after_mm);
    }
  }
}

TEST_CASE("segments whose numbers restart with a window are counted separately") {
  const Vector3 d_mm(1, 0, 0);
  const PathTally tally = tally_of({cut(0, 3, 1, d_mm), cut(0, 3, 1, d_mm), cut(0, 5, 1, d_mm)});
  CHECK(tally.measures().segments_changed == 2);
}

TEST_CASE("the path without the force is that of air") {
  const Measures m = tally_of({cut(0, 3, 5, Vector3(0.3, 0, 0)), cut(1, 4, 5, Vector3(0.5, 0, 0)),
                               cut(2, 6, 5, Vector3(0.1, 0, 0))})
                         .measures();
  CHECK(m.without_force.statistics().max_mm == m.air.mm);
  CHECK(m.without_force.statistics().max_line == m.air.line);
  CHECK(m.air.line == 4);
}

TEST_CASE("a line that comes back has one row with the largest values of both times") {
  const PathTally tally = tally_of({cut(0, 5, 1, Vector3(0.3, 0, 0)), cut(1, 9, 1, Vector3(0.2, 0, 0)),
                                    cut(2, 5, 1, Vector3(0.5, 0, 0)), cut(3, 9, 1, Vector3(0.1, 0, 0))});
  const std::vector<WorstRow> worst = tally.worst(&WorstRow::before_mm);
  REQUIRE(worst.size() == 2);
  CHECK(worst[0].line == 5);
  CHECK(worst[0].before_mm == doctest::Approx(0.5));
  CHECK(worst[0].after_mm == doctest::Approx(0.005));
  CHECK(worst[1].line == 9);
  CHECK(worst[1].before_mm == doctest::Approx(0.2));
}

TEST_CASE("the first ten of equally bad lines are listed") {
  PathTally tally;
  for (int line = 6000; line > 5900; --line) tally.add(cut(1, line, 1, Vector3(0.5, 0, 0)));
  for (int line = 1; line <= 5000; ++line) tally.add(cut(1, line, 1, Vector3(0.5, 0, 0)));
  const std::vector<WorstRow> worst = tally.worst(&WorstRow::after_mm);
  REQUIRE(worst.size() == 10);
  for (int i = 0; i < 10; ++i) CHECK(worst[static_cast<std::size_t>(i)].line == i + 1);
}

TEST_CASE("a line that is not among the worst is forgotten after thousands of lines") {
  WorstLines lines;
  for (int line = 1; line <= 5000; ++line) {
    const double mm_off = line == 1 ? 0.1 : line == 2 ? 0.9 : 0.2;
    WorstRow& row = lines.row(line);
    row.before_mm = row.after_mm = mm_off;
  }
  CHECK(lines.row(1).after_mm == 0);
  CHECK(lines.row(2).after_mm == 0.9);
}

TEST_CASE("a worst line has the places of its largest deviations and the parts of the deviation before") {
  Waypoint small = cut(0, 5, 1, Vector3(0.1, 0, 0)), large = cut(0, 5, 1, Vector3(0.4, 0, 0)),
           last = cut(0, 5, 1, Vector3(0.2, 0, 0));
  small.s = 1 * mm;
  large.s = 2 * mm;
  large.p_MT = Vector3(7, 8, 9) * mm;
  last.s = 3 * mm;
  last.after = 10 * last.after;
  const PathTally tally = tally_of({small, large, last});
  const WorstRow row = tally.worst(&WorstRow::before_mm).at(0);
  CHECK(row.at_before.s_mm == doctest::Approx(2));
  CHECK(row.at_before.place_mm.isApprox(Vector3(7, 8, 9)));
  CHECK(row.at_before.force_N == doctest::Approx(50));
  CHECK(row.at_after.s_mm == doctest::Approx(3));
  REQUIRE(row.causes);
  CHECK(row.causes->geometry_mm == doctest::Approx(0.1));
  CHECK(row.causes->load_mm == doctest::Approx(0.2));
  CHECK(row.causes->discrepancy_mm == doctest::Approx(0.1));
}

TEST_CASE("a line that runs in two operations names the one in which it was worst") {
  PathTally tally;
  tally.add(cut(0, 5, 1, Vector3(0.4, 0, 0)), 0);
  tally.add(cut(1, 5, 1, Vector3(0.1, 0, 0)), 1);
  const WorstRow row = tally.worst(&WorstRow::after_mm).at(0);
  CHECK(row.at_after.operation == 0);
  CHECK(row.at_before.operation == 0);
}
