// What happens between the ends of pieces is found, with few samples where there is little to find.
#include "gantry.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

struct Inside {
  double largest = 0;  ///< m, over all waypoints
  std::size_t samples = 0;
};

/// What `tolerance_failure` judges of pieces that command as they are given.
Inside inside_of(const Shop& shop, const std::vector<Piece>& pieces) {
  const ForwardRun run =
      solve_forward_along(shop.job(), pieces, {.before = false, .attribution = false, .inside = true});
  if (run.failure) FAIL(run.failure->what);
  Inside found;
  for (const Waypoint& w : run.waypoints) {
    found.largest = std::max(found.largest, w.after.head<3>().norm());
    found.samples += w.between;
  }
  return found;
}

/// Every segment one piece, commanded where the tip is right at its ends but nowhere else.
std::vector<Piece> right_at_ends(const Shop& shop) {
  std::vector<Piece> pieces;
  const auto command = [&](std::size_t s, double u) {
    const Vector3 wanted = point_at(shop.path.segments[s].wanted, u);
    Vector3 target = wanted;
    for (int i = 0; i < 6; ++i)
      target += wanted - cold_tip(shop, target, shop.forces->at(s, u, u == 0 ? Side::after : Side::before));
    return target;
  };
  for (std::size_t s = 0; s < shop.path.segments.size(); ++s) {
    const Segment& segment = shop.path.segments[s];
    Piece piece{
        .segment = s, .line = segment.line, .commanded = segment.wanted, .end_only = !segment.cutting};
    piece.commanded.start = command(s, 0);
    piece.commanded.end = command(s, 1);
    pieces.push_back(piece);
  }
  return pieces;
}

/// The same, judged densely and cold.
double dense(const Shop& shop, const std::vector<Piece>& pieces, int inside) {
  std::vector<Commanded> all;
  for (const Piece& piece : pieces)
    if (!piece.end_only) all.push_back({piece.segment, piece.u0, piece.u1, piece.commanded});
  return dense_miss(shop, all, inside).size;
}

/// A head that yields evenly, 10 um to 100 N.
Machine yielding_gantry() {
  Machine machine = perfect_gantry();
  Spring spring;
  spring.K.diagonal() << 1e7, 1e7, 1e7, 1e6, 1e6, 1e6;
  machine.chains[0].elements.push_back(spring);
  return machine;
}

/// Along X in blocks of `block_mm` from 0 on.
std::string blocks(int count, double block_mm) {
  std::string text = "G21 G90\nG0 X-1 Y0 Z0\nG1 X0 F600\n";
  for (int k = 1; k <= count; ++k) text += fmt::format("X{:.3f}\n", k * block_mm);
  return text + "M30\n";
}

}  // namespace

TEST_CASE("a narrow spike of the force inside a long block is found") {
  Order order{.machine = yielding_gantry(),
              .text = blocks(1, 150),
              .force = step_profile("0,10,0,0\n100.3,300,0,0\n100.7,10,0,0\n", 0.2e-3)};
  const Shop shop(order);
  const std::vector<Piece> pieces = right_at_ends(shop);
  const double largest = dense(shop, pieces, 3000);
  CHECK(largest > 28e-6);
  CHECK(inside_of(shop, pieces).largest > 0.99 * largest);
  CHECK(tolerance_failure(
      shop.job(), solve_forward_along(shop.job(), pieces, {.before = false, .inside = true}).waypoints));
}

TEST_CASE("a spike inside one of many short blocks is found, and the others are sampled but seldom") {
  for (const char* const side : {"20.35,300,0,0\n20.45,10,0,0\n", "20.35,0,-90,0\n20.45,10,0,0\n"}) {
    const Shop shop({.machine = yielding_gantry(),
                     .text = blocks(60, 1),
                     .force = step_profile("0,10,0,0\n" + std::string(side), 0.1e-3)});
    const std::vector<Piece> pieces = right_at_ends(shop);
    const double largest = dense(shop, pieces, 40);
    CHECK(largest > 8e-6);
    const Inside found = inside_of(shop, pieces);
    CHECK(found.largest > 0.99 * largest);
    CHECK(found.samples < 40);
  }
}

TEST_CASE("a row is sampled where the response to the force is not what was foreseen") {
  // A bent strut that buckles at 5000 N, the more yielding the nearer it is to that; a spike of 100 N inside
  // one of the short blocks behind the first long one. The response is measured at the end, behind the
  // second.
  std::string text = "G21 G90\nG0 X300. Y0. Z0.\nG1 X340. F100\n";
  for (int k = 1; k <= 8; ++k) text += fmt::format("X{:.3f}\n", 340 + 0.5 * k);
  text += "X384.\nX384.5\nX385.\nM30\n";
  Order order{.machine = load_machine(strut), .text = text, .tolerance = 0.2e-3, .max_correction = 1};
  std::get<Spring>(order.machine.chains[0].elements[3]).theta_0[4] = 0.005;
  const auto samples_on_short_blocks = [&](int force, int last) {
    order.force = step_profile(
        fmt::format("0,{},5,0\n42.2,{},5,0\n42.3,{},5,0\n60,{},5,0\n", force, force - 100, force, last),
        0.05e-3);
    const Shop shop(order);
    const ForwardRun run = solve_forward_along(shop.job(), right_at_ends(shop), {.before = false});
    return std::count_if(run.waypoints.begin(), run.waypoints.end(),
                         [](const Waypoint& w) { return w.between && w.line >= 4 && w.line <= 11; });
  };
  CHECK(samples_on_short_blocks(-100, -100) < 6);
  CHECK(samples_on_short_blocks(-4400, -4400) > 8);
  CHECK(samples_on_short_blocks(-4400, -100) > 8);
}

TEST_CASE("a wave of the deviation on an arc is found") {
  const Shop shop({.machine = load_machine(orthoglide_b),
                   .text = "G21 G90 G17\nG0 X60 Y0 Z0\nG2 X60 Y0 I-60 J0 F600\nM30\n",
                   .force = constant_force(milling(), 0)});
  const std::vector<Piece> pieces = right_at_ends(shop);
  const double largest = dense(shop, pieces, 100);
  CHECK(largest > 100e-6);
  CHECK(inside_of(shop, pieces).largest > 0.95 * largest);
}

TEST_CASE("a correction that bends along a long block is found") {
  for (const double end : {126.35, -20.0, -60.0}) {
    const Shop shop({.machine = load_machine(orthoglide_b),
                     .text = fmt::format("G21 G90\nG0 X-73.65 Y-73.65 Z-73.65\nG1 Y{} F600\nM30\n", end),
                     .force = constant_force(milling(), 0)});
    const std::vector<Piece> pieces = right_at_ends(shop);
    CHECK(inside_of(shop, pieces).largest > 0.98 * dense(shop, pieces, 100));
  }
}

TEST_CASE("short blocks under a force of their own each are followed within the tolerance, inside too") {
  std::string text = "G21 G90\nG0 X0 Y0 Z0\nG1 F600\n", rows = "# frame = machine\n# sense = on_tool\n";
  rows += "line,fx_N,fy_N,fz_N\n";
  for (int k = 1; k <= 300; ++k) {
    text +=
        fmt::format("X{:.3f} Y{:.3f} Z{:.3f}\n", 0.3 * k, 4 * std::sin(0.1 * k), 0.7 * std::cos(0.31 * k));
    rows += fmt::format("{},{:.2f},{:.2f},{:.2f}\n", k + 3, 120 + 60 * std::sin(0.2 * k),
                        40 * std::cos(2.3 * k), -25 + 10 * std::sin(1.7 * k));
  }
  ForceSource force;
  force.rules = read_force_csv(rows, "forces.csv");
  const Shop shop({.machine = load_machine(orthoglide_b), .text = text + "M30\n", .force = force});
  const Compensation result = compensated(shop);
  const Miss miss = dense_miss(shop, result, 7);
  CAPTURE(miss.line);
  CHECK(miss.size <= 5e-6);
  std::size_t between = 0;
  for (const Waypoint& w : result.waypoints) {
    between += w.between;
  }
  CHECK(between < 200);
  CHECK(between > 30);
}
