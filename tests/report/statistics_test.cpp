#include "counterflex/report/statistics.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

DeviationSample sample(const Vector3& d_mm, double weight, int line) {
  DeviationSample s;
  s.deviation.head<3>() = d_mm * mm;
  s.direction = Vector3::UnitX();
  s.weight = weight;
  s.line = line;
  return s;
}

}  // namespace

TEST_CASE("mean, rms and p95 weight every sample by its share of the length") {
  DeviationTally tally;
  tally.add(sample({3, 4, 0}, 1, 10));    // 5 mm on 1 m
  tally.add(sample({0, -1, 0}, 99, 20));  // 1 mm on 99 m
  const DeviationStatistics s = tally.statistics();
  CHECK(s.mean_mm == doctest::Approx((5 + 99) / 100.0).epsilon(1e-12));
  CHECK(s.rms_mm == doctest::Approx(std::sqrt((25 + 99) / 100.0)).epsilon(1e-12));
  CHECK(s.p95_mm >= 1 - 1e-12);
  CHECK(s.p95_mm <= 1.001 + 1e-12);
  CHECK(s.max_mm == doctest::Approx(5).epsilon(1e-12));
  CHECK(s.max_line == 10);
}

TEST_CASE("p95 is the deviation below which 95 % of the length lies, to 0.1 %") {
  DeviationTally tally;
  for (int i = 1; i <= 1000; ++i) tally.add(sample({0, 0, i * 1e-3}, 0.5, i));
  const double p95 = tally.statistics().p95_mm.value();
  CHECK(p95 >= 0.950 * (1 - 1e-9));
  CHECK(p95 <= 0.950 * 1.001 * (1 + 1e-9));
}

TEST_CASE("p95 is never above the maximum and is zero where nothing deviates") {
  DeviationTally one;
  one.add(sample({0.1234, 0, 0}, 1, 1));
  CHECK(one.statistics().p95_mm == doctest::Approx(0.1234).epsilon(1e-12));
  CHECK(one.statistics().p95_mm <= one.statistics().max_mm);
  DeviationTally none;
  none.add(sample({0, 0, 0}, 1, 1));
  CHECK(none.statistics().p95_mm == 0);
}

TEST_CASE("a sample without weight counts only in the maxima") {
  DeviationTally tally;
  tally.add(sample({1, 0, 0}, 2, 5));
  tally.add(sample({0, 0, -7}, 0, 6));
  const DeviationStatistics s = tally.statistics();
  CHECK(s.max_mm == doctest::Approx(7));
  CHECK(s.max_line == 6);
  CHECK(s.mean_mm == doctest::Approx(1));
  CHECK(s.max_axis_mm.isApprox(Vector3(1, 0, 7)));
}

TEST_CASE("the worst line is the first with the largest deviation, and 0 without samples") {
  DeviationTally tally;
  CHECK(tally.statistics().max_line == 0);
  tally.add(sample({2, 0, 0}, 1, 8));
  tally.add(sample({-2, 0, 0}, 1, 9));
  CHECK(tally.statistics().max_line == 8);
  DeviationTally still;
  still.add(sample({0, 0, 0}, 1, 3));
  CHECK(still.statistics().max_line == 3);
}

TEST_CASE("the largest rotation is an angle in degrees") {
  DeviationTally tally;
  DeviationSample s = sample({0, 0, 0}, 1, 1);
  s.deviation.tail<3>() = Vector3(0.3, 0, -0.4) * deg;
  tally.add(s);
  CHECK(tally.statistics().max_rotation_deg == doctest::Approx(0.5).epsilon(1e-12));
}

TEST_CASE("a deviation is split along the path, across it and along the tool axis") {
  const Vector3 diagonal = Vector3(1, 1, 0).normalized();
  const DeviationSplit s = split_deviation({3, 1, -5}, diagonal, Vector3::UnitZ());
  CHECK(s.along == doctest::Approx(4 / std::sqrt(2.0)));
  CHECK(s.across == doctest::Approx(2 / std::sqrt(2.0)));
  CHECK(s.tool_axis == doctest::Approx(5));
}

TEST_CASE("in a plunge the part perpendicular to the tool axis is across") {
  const DeviationSplit s = split_deviation({3, 4, -2}, -Vector3::UnitZ(), Vector3::UnitZ());
  CHECK(s.along == doctest::Approx(2));
  CHECK(s.across == doctest::Approx(5));
  CHECK(s.tool_axis == doctest::Approx(2));
  CHECK(split_deviation({3, 4, -2}, Vector3::Zero(), Vector3::UnitZ()).across == doctest::Approx(5));
}

TEST_CASE("tallies merged in order equal one tally of all samples") {
  DeviationTally all, first, second;
  for (int i = 0; i < 100; ++i) {
    const DeviationSample s = sample({std::sin(i), std::cos(3 * i), 0.01 * i}, 0.1 + 0.01 * (i % 7), i + 1);
    all.add(s);
    (i < 37 ? first : second).add(s);
  }
  first.merge(second);
  const DeviationStatistics a = all.statistics(), b = first.statistics();
  CHECK(first.samples() == all.samples());
  CHECK(b.max_mm == a.max_mm);
  CHECK(b.max_line == a.max_line);
  CHECK(b.p95_mm == a.p95_mm);
  CHECK(b.mean_mm == doctest::Approx(a.mean_mm.value()).epsilon(1e-13));
  CHECK(b.rms_mm == doctest::Approx(a.rms_mm.value()).epsilon(1e-13));
  CHECK(b.max_axis_mm == a.max_axis_mm);
  CHECK(b.max_across_mm == a.max_across_mm);
  CHECK(b.max_along_mm == a.max_along_mm);
  CHECK(b.max_tool_axis_mm == a.max_tool_axis_mm);
}

}  // namespace counterflex
