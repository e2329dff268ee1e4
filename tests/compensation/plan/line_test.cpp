// Long moves on the Orthoglide: few points, and a tip that stays on the path between them.
#include "compensation/support/judge.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// The paper's line Q2-Q5 with its milling wrench.
Order paper_line(double blend) {
  return {.machine = load_machine(orthoglide_b),
          .text = "G21 G90\nG0 X-73.65 Y-73.65 Z-73.65\nG1 Y126.35 F600\nM30\n",
          .force = constant_force(milling(), blend)};
}

/// The correction along the only cut, solved cold by fixed point iteration on the tip's miss.
std::vector<Vector3> dense_correction(const Shop& shop, std::size_t segment, int count) {
  std::vector<Vector3> c;
  const Segment& line = shop.path.segments[segment];
  Vector3 guess = Vector3::Zero();
  for (int k = 0; k <= count; ++k) {
    const double u = static_cast<double>(k) / count;
    const Vector3 wanted = line.wanted.start + u * (line.wanted.end - line.wanted.start);
    for (int i = 0; i < 30; ++i) {
      const Vector3 miss = cold_tip(shop, wanted + guess, shop.forces->at(segment, u)) - wanted;
      guess -= miss;
      if (miss.norm() < 1e-10) break;
    }
    c.push_back(guess);
  }
  return c;
}

bool straight_enough(const std::vector<Vector3>& c, std::size_t a, std::size_t b, double tolerance) {
  for (std::size_t k = a + 1; k < b; ++k) {
    const double w = static_cast<double>(k - a) / static_cast<double>(b - a);
    if ((c[k] - (1 - w) * c[a] - w * c[b]).norm() > tolerance) return false;
  }
  return true;
}

/// Least number of segments with knots on the curve: a shortest path over all pairs of dense samples.
std::size_t optimal_segments(const std::vector<Vector3>& c, double tolerance) {
  std::vector<std::size_t> least(c.size(), c.size());
  least[0] = 0;
  for (std::size_t a = 0; a + 1 < c.size(); ++a)
    for (std::size_t b = a + 1; b < c.size(); ++b)
      if (least[a] + 1 < least[b] && straight_enough(c, a, b, tolerance)) least[b] = least[a] + 1;
  return least.back();
}

}  // namespace

TEST_CASE("the paper's line takes at most 1.3 times the segments of the optimal interpolation") {
  const Shop shop(paper_line(0));
  const std::vector<Vector3> c = dense_correction(shop, 0, 400);
  const std::size_t exact = optimal_segments(c, 5e-6), rounded = optimal_segments(c, 5e-6 - 0.866e-6);
  CHECK(exact == 7);
  CHECK(rounded == 8);
  const Compensation result = compensated(shop);
  const std::size_t segments = pieces_on(result, 3);
  CHECK(segments >= exact);
  CHECK(segments <= 1.3 * static_cast<double>(exact));
}

TEST_CASE("the tip stays within the tolerance between the points of the paper's line" *
          doctest::test_suite("long")) {
  for (const double blend : {0.0, 2e-3}) {
    CAPTURE(blend);
    const Shop shop(paper_line(blend));
    const Miss miss = dense_miss(shop, compensated(shop), blend == 0 ? 400 : 100);
    CAPTURE(miss.u);
    CHECK(miss.size <= 5e-6);
    CHECK(miss.size > 1e-6);
  }
}

TEST_CASE("tighter and looser tolerances are met with more and fewer points" * doctest::test_suite("long")) {
  struct Asked {
    double tolerance;
    int decimals;
  };
  std::size_t more = 0;
  for (const Asked asked : {Asked{50e-6, -1}, Asked{5e-6, -1}, Asked{1e-6, 5}}) {
    CAPTURE(asked.tolerance);
    Order order = paper_line(2e-3);
    order.tolerance = asked.tolerance;
    order.decimals = asked.decimals;
    const Shop shop(order);
    const Compensation result = compensated(shop);
    const Miss miss = dense_miss(shop, result, 60);
    CAPTURE(miss.u);
    CHECK(miss.size <= asked.tolerance);
    CHECK(pieces_on(result, 3) > more);
    more = pieces_on(result, 3);
  }
}

TEST_CASE("with a load scale of nothing the geometry alone is corrected") {
  Order order = paper_line(2e-3);
  order.force.scale = 0;
  const Shop scaled(order);
  order.force = {};
  const Shop unloaded(order);
  const Compensation result = compensated(scaled);
  CHECK(result.text == compensated(unloaded).text);
  CHECK(dense_miss(unloaded, result, 100).size <= 5e-6);
}

TEST_CASE("the sample is corrected, ramp and all, in every case of the machine's assembly") {
  const std::string text = read_file(groove);
  for (const std::string& machine : {orthoglide_a, orthoglide_b, orthoglide_perfect}) {
    CAPTURE(machine);
    const Shop shop({.machine = load_machine(machine), .text = text});
    const Miss miss = dense_miss(shop, compensated(shop), 40);
    CAPTURE(miss.line);
    CAPTURE(miss.u);
    CHECK(miss.size <= 5e-6);
  }
}

TEST_CASE("long moves in every direction are followed within the tolerance" * doctest::test_suite("long")) {
  const Shop shop({.machine = load_machine(orthoglide_b),
                   .text = "G21 G90\nG0 X-70 Y-70 Z-70\n"
                           "G1 X120 F600\nG1 Y120\nG1 Z120\nG1 X-70 Y-70 Z-70\nG1 X100 Y20 Z60\nM30\n",
                   .force = constant_force(milling())});
  const Miss miss = dense_miss(shop, compensated(shop), 40);
  CAPTURE(miss.line);
  CAPTURE(miss.u);
  CHECK(miss.size <= 5e-6);
}

TEST_CASE("an inch program is corrected in inches") {
  const Shop shop({.machine = load_machine(orthoglide_b),
                   .text = "G20 G90\nG0 X-2.9 Y-2.9 Z-2.9\nG1 Y5. F24.\nM30\n",
                   .force = constant_force(milling())});
  const Compensation result = compensated(shop);
  CHECK(dense_miss(shop, result, 100).size <= 5e-6);
  for (const Move& move : read_program(result.text, "corrected.ngc", {}).moves)
    CHECK(move.unit == LengthUnit::inches);
}
