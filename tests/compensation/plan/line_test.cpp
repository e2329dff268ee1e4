// Long moves on the Orthoglide: few points, and a tip that stays on the path between them.
#include "compensation/support/gantry.hpp"

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

// Between two positions a table goes from one side of its chord to the other, and so does the deflection of a
// joint with a knee while the force turns round: the middle is on the chord.
TEST_CASE("a line whose correction crosses its chord in the middle is followed on both sides") {
  const std::string table =
      "[error_tables.x]\npositions_mm = [-50, 100, 105, 300]\nEYX_um = [-60, -60, 60, 60]\n";
  const std::string knee = knee_along('x', 5e6, 100, 5e7);
  const ForceSource linear = linear_profile("0,-300,0,0\n200,300,0,0\n", 2e-3);
  const Order orders[] = {{.machine = slides(table, ", error_table = \"x\"", ""),
                           .text = "G21 G90 G17\nG0 X100 Y0 Z0\nG1 X105 F500\nY5\nM30\n"},
                          {.machine = slides(table, ", error_table = \"x\"", ""),
                           .text = "G21 G90 G17\nG0 X100.1 Y0 Z0\nG1 X104.9 F500\nM30\n"},
                          {.machine = slides("", "", knee),
                           .text = "G21 G90 G17\nG0 X0 Y0 Z0\nG1 Y200 F500\nM30\n",
                           .force = linear},
                          {.machine = slides("", "", knee),
                           .text = "G21 G90 G17\nG0 X0 Y0 Z0\nG1 Y50 F500\nY0\nY50\nM30\n",
                           .force = step_profile("0,-300,0,0\n50,300,0,0\n100,-300,0,0\n", 2e-3)}};
  for (const Order& order : orders) {
    CAPTURE(order.text);
    const Shop shop(order);
    const Miss miss = dense_miss(shop, compensated(shop), 400);
    CAPTURE(miss.u);
    CHECK(miss.size <= 5.001e-6);
  }
}

// Two knots that are as far apart as the tolerance allows have the corner between them.
TEST_CASE("a line along which the load of a joint passes its knee is followed at the corner, too") {
  for (const double share : {0.03, 0.45, 0.55, 0.65, 0.95})
    for (const double length : {4.0, 10.0, 20.0, 40.0})
      for (const double part : {0.985, 0.96, 0.93}) {
        CAPTURE(share);
        CAPTURE(length);
        CAPTURE(part);
        const double height = 200 * share / 1e7 * (1 - share);  // of the corner above the chord
        const Shop shop({.machine = slides("", "", knee_along('y', 1e7, 200 * share, 1e9)),
                         .text = fmt::format("G21 G90 G17\nG0 X0 Y0 Z0\nG1 X{} F500\nM30\n", length),
                         .force = linear_profile(fmt::format("0,0,0,0\n{},0,200,0\n", length), 0),
                         .tolerance = part * height,
                         .decimals = 5});
        const Compensation result = compensated(shop);
        CHECK(dense_miss(shop, result, 999).size <= 1.0001 * shop.options.tolerance);
      }
}

TEST_CASE("the deviation before is that at the positions of a table") {
  const Shop shop({.machine = slides("[error_tables.x]\npositions_mm = [0, 189, 190, 191, 192, 400]\n"
                                     "EYX_um = [0, 0, 0, 50, 0, 0]\n",
                                     ", error_table = \"x\"", ""),
                   .text = "G21 G90 G17\nG0 X0.7 Y0 Z0\nG1 X211.5 F500\nM30\n"});
  const ForwardRun run = solve_pieces(shop.job(), original_pieces(shop.job()), {.inside = false});
  REQUIRE(!run.failure);
  double largest = 0;
  for (const Waypoint& w : run.waypoints) largest = std::max(largest, w.before.head<3>().norm());
  CHECK(largest == doctest::Approx(50e-6).epsilon(1e-3));
}
