// What happens between the ends of pieces is found.
#include "compensation/support/gantry.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// The largest deviation (m) that `tolerance_failure` judges of pieces that command as they are given.
double inside_of(const Shop& shop, const std::vector<Piece>& pieces) {
  const ForwardRun run =
      solve_pieces(shop.job(), pieces, {.before = false, .attribution = false, .inside = true});
  if (run.failure) FAIL(run.failure->what);
  double largest = 0;
  for (const Waypoint& w : run.waypoints) largest = std::max(largest, w.after.head<3>().norm());
  return largest;
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
    Piece piece{.segment = s,
                .move = segment.move,
                .line = segment.line,
                .frame = segment.frame,
                .commanded = segment.wanted,
                .end_only = !segment.cutting};
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
  CHECK(inside_of(shop, pieces) > 0.99 * largest);
  CHECK(tolerance_failure(shop.job(),
                          solve_pieces(shop.job(), pieces, {.before = false, .inside = true}).waypoints));
}

TEST_CASE("a spike inside one of many short blocks is found") {
  for (const char* const side : {"20.35,300,0,0\n20.45,10,0,0\n", "20.35,0,-90,0\n20.45,10,0,0\n"}) {
    const Shop shop({.machine = yielding_gantry(),
                     .text = blocks(60, 1),
                     .force = step_profile("0,10,0,0\n" + std::string(side), 0.1e-3)});
    const std::vector<Piece> pieces = right_at_ends(shop);
    const double largest = dense(shop, pieces, 40);
    CHECK(largest > 8e-6);
    CHECK(inside_of(shop, pieces) > 0.99 * largest);
  }
}

TEST_CASE("a hump of the force between the samples of a long block is found by closer samples") {
  // Places are at 10 and 15 mm, the middle between them at 12.5 mm. The mean over 2 mm is largest at 11.25
  // mm.
  const ForceSource force =
      linear_profile("0,10,0,0\n9.75,10,0,0\n11.25,310,0,0\n12.75,10,0,0\n151,10,0,0\n", 2e-3);
  const Shop shop({.machine = yielding_gantry(), .text = blocks(1, 150), .force = force});
  const std::vector<Piece> pieces = right_at_ends(shop);
  const double largest = dense(shop, pieces, 3000);
  CHECK(largest > 15e-6);
  CHECK(inside_of(shop, pieces) > 0.9 * largest);
}

TEST_CASE("the corner of the deviation where the load of a joint passes its knee is found") {
  const ForceSource force = linear_profile("0,0,0,0\n1,0,0,0\n5,0,200,0\n", 0);
  for (const double knee_N : {6, 30, 71, 110}) {
    CAPTURE(knee_N);
    const Shop shop(
        {.machine = slides("", "", knee_along('y', 3e6, knee_N, 1e9)), .text = blocks(1, 4), .force = force});
    const std::vector<Piece> pieces = right_at_ends(shop);
    const double largest = dense(shop, pieces, 3999);
    CHECK(largest > 1.7e-6);
    CHECK(inside_of(shop, pieces) > 0.99 * largest);
  }
}

TEST_CASE(
    "without bounds every feed piece is sampled in its own middle, arcs every 11.25 degrees on all of their "
    "turns") {
  const Shop shop({.machine = perfect_gantry(),
                   .text =
                       "G21 G90 G17\nG0 X10 Y0 Z0\nG1 X10.5 F600\nX11\nX11.5\nX12\nG3 X12 Y0 Z-2 I-12 J0 P6\n"
                       "G3 X0 Y12 I-12 J0\nM30\n",
                   .in_batches = false});
  const std::vector<Piece> pieces = right_at_ends(shop);
  const ForwardRun run = solve_pieces(shop.job(), pieces, {});
  REQUIRE(!run.failure);
  for (const Piece& piece : pieces) {
    if (piece.end_only) continue;
    CAPTURE(piece.line);
    const double sweep = piece.commanded.arc ? piece.commanded.arc->sweep : 0;
    double last = 0, widest = 0;
    for (const Waypoint& w : run.waypoints) {
      if (w.segment != piece.segment) continue;
      widest = std::max(widest, w.fraction - last);
      last = w.fraction;
    }
    CHECK(last == 1);
    CHECK(widest <= 0.5);
    CHECK(widest * sweep <= 11.25 * deg * (1 + 1e-9));
  }
}

TEST_CASE(
    "a short line is judged by its ends where its cell bounds the rest, and inside where they leave too "
    "little") {
  const Shop shop({.machine = load_machine(orthoglide_b),
                   .text = blocks(40, 0.1),
                   .force = constant_force(milling(), 0)});
  const auto miss_of_ends = [&](double miss) {
    std::vector<Piece> pieces = right_at_ends(shop);
    for (Piece& piece : pieces) {
      piece.commanded.start.z() += miss;
      piece.commanded.end.z() += miss;
    }
    return pieces;
  };
  const auto inside = [&](const std::vector<Piece>& pieces) {
    const ForwardRun run = solve_pieces(shop.job(), pieces, {.before = false});
    REQUIRE(!run.failure);
    return std::ranges::count_if(run.waypoints,
                                 [](const Waypoint& w) { return w.between && !w.place && w.fraction > 0; });
  };
  const double tolerance = shop.options.tolerance;
  CHECK(inside(miss_of_ends(0.5 * tolerance)) == 0);
  CHECK(dense(shop, miss_of_ends(0.5 * tolerance), 7) < 0.8 * tolerance);
  CHECK(inside(miss_of_ends(0.85 * tolerance)) >= 40);
}

TEST_CASE(
    "a short line has places at corners of the force only where it may bend there, or the force is largest "
    "there") {
  // Line 11 has a step of the force and one back, as ramps of 0.2 mm.
  const auto shop_of = [](double step, const Machine& machine = yielding_gantry()) {
    const std::string rows = fmt::format("0,100,0,0\n8.3,{},0,0\n8.7,100,0,0\n", 100 + step);
    return Shop({.machine = machine, .text = blocks(12, 1), .force = step_profile(rows, 0.2e-3)});
  };
  const auto places_in = [](const Shop& shop) {
    const auto is_there = [](const Piece& piece) { return piece.line == 11; };
    return std::ranges::count_if(original_pieces(shop.job()), is_there);
  };
  CHECK(places_in(shop_of(-60)) == 5);
  CHECK(places_in(shop_of(2)) == 5);  // a larger force acts inside
  CHECK(places_in(shop_of(300, perfect_gantry())) == 5);
  const Shop shop = shop_of(-2);
  CHECK(places_in(shop) == 1);
  const auto segment = static_cast<std::size_t>(std::ranges::find(shop.path.segments, 11, &Segment::line) -
                                                shop.path.segments.begin());
  const auto deviation_at = [&](double u) {
    const Vector3 p = point_at(shop.path.segments[segment].wanted, u);
    return Vector3(cold_tip(shop, p, shop.forces->at(segment, u, Side::before)) - p);
  };
  double most = 0;
  for (int k = 0; k <= 100; ++k) {
    const double u = 0.01 * k;
    most = std::max(most, (deviation_at(u) - (1 - u) * deviation_at(0) - u * deviation_at(1)).norm());
  }
  CHECK(most > 0.1e-6);  // the force bends
  CHECK(most <= 0.1 * shop.options.tolerance);
}

TEST_CASE("a wave of the deviation on an arc is found") {
  const Shop shop({.machine = load_machine(orthoglide_b),
                   .text = "G21 G90 G17\nG0 X60 Y0 Z0\nG2 X60 Y0 I-60 J0 F600\nM30\n",
                   .force = constant_force(milling(), 0)});
  const std::vector<Piece> pieces = right_at_ends(shop);
  const double largest = dense(shop, pieces, 100);
  CHECK(largest > 100e-6);
  CHECK(inside_of(shop, pieces) > 0.95 * largest);
}

TEST_CASE("a correction that bends along a long block is found") {
  for (const double end : {126.35, -20.0, -60.0}) {
    const Shop shop({.machine = load_machine(orthoglide_b),
                     .text = fmt::format("G21 G90\nG0 X-73.65 Y-73.65 Z-73.65\nG1 Y{} F600\nM30\n", end),
                     .force = constant_force(milling(), 0)});
    const std::vector<Piece> pieces = right_at_ends(shop);
    CHECK(inside_of(shop, pieces) > 0.98 * dense(shop, pieces, 100));
  }
}

TEST_CASE("short blocks under a force of their own each are followed within the tolerance, inside too" *
          doctest::test_suite("long")) {
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
}
