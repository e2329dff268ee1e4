// Axes that lag behind their commands, against the direction of their motion.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compensation/support/judge.hpp"
#include "compensation/support/window_run.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

// Perfect but for a reversal of 20 µm in X, 12 µm in Y and 8 µm in Z.
Machine mill_with_reversal() {
  return read_machine(R"(format = "counterflex-machine 1"
controlled = ["x", "y", "z"]
[springs.head]
stiffness_diag_si = [2e7, 2e7, 5e7, 1e6, 1e6, 1e6]
[[chain]]
name = "axes"
elements = [
  { actuator = "prismatic", axis = "x", min_mm = -400, max_mm = 400, reversal_um = 20 },
  { actuator = "prismatic", axis = "y", min_mm = -400, max_mm = 400, reversal_um = 12 },
  { actuator = "prismatic", axis = "z", min_mm = -400, max_mm = 400, reversal_um = 8 },
  { spring = "head" },
]
)",
                      "mill.toml");
}

Machine arm_with_reversal() {
  std::string text = read_file(robot);
  std::size_t at = 0;
  for (int k = 0; k < 6; ++k) {
    at = text.find("{ actuator = \"revolute\"", at);
    REQUIRE(at != std::string::npos);
    at = text.find('}', at);
    text.insert(at, ", reversal_arcsec = 30 ");
    at += 30;
  }
  return read_machine(text, "arm.toml");
}

std::vector<std::string> reversals_of(const Shop& shop) {
  std::vector<std::string> list;
  for (const DirectionChange& change : shop.directions.changes())
    if (change.is_reversal)
      list.push_back(fmt::format("{} {} {:.3f}", shop.program.moves[change.move].line,
                                 shop.model.mechanism.travel[change.actuator].name, change.u));
  return list;
}

double largest_after(const Shop& shop, const Compensation& result) {
  double largest = 0;
  for (const Waypoint& w : result.waypoints) largest = std::max(largest, position_miss(shop.job(), w));
  return largest;
}

const char* const corners = "G21 G90\nG0 X0. Y0. Z5.\nG1 Z0. F500\nX10.\nX20. Y-5.\nX5.\nY5.\nG0 Z5.\nM30\n";

}  // namespace

TEST_CASE("axes reverse where their nominal motion does, and keep their direction where they do not move") {
  const Shop shop({.machine = mill_with_reversal(), .text = corners});
  CHECK(reversals_of(shop) == std::vector<std::string>{"6 axis X 0.000", "7 axis Y 0.000", "8 axis Z 0.000"});
  const auto at = [&](std::size_t move, double u) { return shop.directions.at(move, u, Side::after); };
  CHECK(at(2, 0.5).of(0) == 1);
  CHECK(at(2, 0.5).of(1) == -1);  // the direction of its first motion
  CHECK(at(4, 0.5).of(0) == -1);
  CHECK(at(5, 0.5).of(0) == -1);  // X does not move
  CHECK(at(5, 0.5).of(1) == 1);
}

TEST_CASE(
    "an axis that comes from an unknown position keeps its last direction, which is in doubt until it "
    "moves") {
  const auto doubts_of = [](const Shop& shop) {
    std::vector<std::string> list;
    for (const DoubtfulDirection& doubt : shop.directions.doubtful())
      list.push_back(fmt::format("{} {} {}", doubt.line, shop.model.mechanism.travel[doubt.actuator].name,
                                 doubt.lost_before));
    return list;
  };
  const std::string cut = "G21 G90\nG0 X0. Y0. Z5.\nG1 Z0. F500\nX10. Y5.\nG0 Z5.\n",
                    next = "G1 Z0.\nY20.\nX30.\nY10.\nM30\n";
  const Shop known({.machine = mill_with_reversal(), .text = cut + "G0 X-50.\nG0 X-5.\n" + next});
  CHECK(doubts_of(known).empty());
  for (const char* way : {"G53 G0 X-50.\nG0 X-5.\n", "G28 X0.\nG0 X-5.\n"}) {
    CAPTURE(way);
    const Shop shop({.machine = mill_with_reversal(), .text = cut + way + next});
    CHECK(doubts_of(shop) == std::vector<std::string>{"8 axis X 7"});
    const auto of_line = [&](int line) {
      const auto found = std::ranges::find(shop.program.moves, line, &Move::line);
      return shop.directions.at(static_cast<std::size_t>(found - shop.program.moves.begin()), 0.5,
                                Side::after);
    };
    CHECK(of_line(9).of(0) == 1);  // a motion to -5 from where it was before would have another sign
    CHECK(of_line(9).of(1) == 1);
    CHECK(of_line(11).of(0) == 1);
    CHECK(reversals_of(shop) ==
          std::vector<std::string>{"5 axis Z 0.000", "8 axis Z 0.000", "11 axis Y 0.000"});
  }
}

TEST_CASE("a drill comes down to the bottom of each hole") {
  const std::string start = "G21 G90 G17\nG0 X0. Y0. Z20.\n";
  for (const std::string holes :
       {"G98 G81 X5. Y0. Z-3. R2. F100\nX10.\nX15.\n", "G99 G81 X5. Y0. Z-3. R2. F100\nX10.\nX15.\n",
        "G53 G0 Z100.\nG98 G81 X5. Y0. Z-3. R2. F100\nX10.\nX15.\n"}) {
    CAPTURE(holes);
    const Shop shop({.machine = mill_with_reversal(), .text = start + holes + "G80\nG0 Z20.\nM30\n"});
    std::size_t count = 0;
    for (std::size_t m = 0; m < shop.program.moves.size(); ++m) {
      if (!shop.program.moves[m].cycle) continue;
      CHECK(shop.directions.at(m, 1, Side::before).of(2) == -1);
      ++count;
    }
    CHECK(count == 3);
  }
  const Shop called(
      {.machine = mill_with_reversal(),
       .text = "BEGIN PGM K MM\nTOOL CALL 1 Z S2000\nL Z+20 R0 FMAX\nCYCL DEF 200 Q200=2 Q201=-3 "
               "Q206=100 Q203=+0 Q204=20\nL X+5 Y+5 R0 FMAX M99\nL X+10 R0 FMAX M99\nEND PGM K MM\n"});
  for (std::size_t m = 1; m < called.program.moves.size(); ++m)
    CHECK(called.directions.at(m, 1, Side::before).of(2) == -1);
}

TEST_CASE("a command leads its axis by half of the reversal, and a point takes up the lost motion") {
  const Shop shop({.machine = mill_with_reversal(), .text = corners, .tolerance = 2e-6, .decimals = 4});
  const Compensation result = compensated(shop);
  CAPTURE(result.text);
  CHECK(largest_after(shop, result) < 1e-6);
  CHECK(result.text.find("X20.01 Y-5.006") != std::string::npos);
  CHECK(result.text.find("X19.99") != std::string::npos);
  CHECK(result.text.find("Y-4.994") != std::string::npos);
  CHECK(result.counts.inserted_blocks == 2);
}

TEST_CASE("before the correction an axis is off by half of its reversal, which belongs to the geometry") {
  const Shop shop({.machine = mill_with_reversal(), .text = corners});
  const Compensation result = compensated(shop, true);
  for (const Waypoint& w : result.waypoints) {
    if (!knows_before(w)) continue;
    CHECK(std::abs(w.before[0]) == doctest::Approx(1e-5).epsilon(1e-6));
    CHECK(w.before[0] == doctest::Approx(-1e-5 * w.directions.of(0)).epsilon(1e-6));
    CHECK((w.before - (*w.causes).geometry).norm() < 1e-12);
  }
}

TEST_CASE("around a circle axes reverse at the quadrants, and the tip stays within the tolerance") {
  const Shop shop({.machine = mill_with_reversal(),
                   .text = "G21 G90\nG0 X50. Y0. Z0.\nG1 X40. F500\nG3 X40. Y0. I-40. J0.\nG0 Z5.\nM30\n"});
  std::vector<std::string> found = reversals_of(shop);
  REQUIRE(found.size() >= 3);
  int inside = 0;
  for (const DirectionChange& change : shop.directions.changes()) {
    if (!change.is_reversal || change.u == 0) continue;
    CHECK(std::abs(4 * change.u - std::round(4 * change.u)) < 1e-3);
    ++inside;
  }
  CHECK(inside == 3);
  const Compensation result = compensated(shop);
  CHECK(largest_after(shop, result) < 5e-6);
}

TEST_CASE("a joint of an arm turns back inside a straight line, which is divided there") {
  const Shop shop({.machine = arm_with_reversal(),
                   .text = "G21 G90\nG0 X1900. Y-300. Z1100.\nG1 Y300. F5000\nM30\n",
                   .tolerance = 20e-6});
  bool turns = false;
  for (const DirectionChange& change : shop.directions.changes())
    if (change.is_reversal && change.u > 0.01 && change.u < 0.99) {
      turns = true;
      CHECK(std::abs(change.u - 0.5) < 1e-3);  // the line is nearest to the base in its middle
    }
  CHECK(turns);
  const Compensation result = compensated(shop);
  CHECK(largest_after(shop, result) < 20e-6);
  CHECK(result.counts.inserted_blocks >= 2);
}

TEST_CASE("answers with reversals do not depend on batches or windows") {
  std::string text = "G21 G90\nG0 X0. Y0. Z5.\nG1 Z0. F500\n";
  for (int i = 0; i < 60; ++i)
    text += fmt::format("G1 X{:.3f} Y{:.3f}\n", 20 * std::sin(0.9 * i), 15 * std::cos(0.37 * i));
  text += "G0 Z5.\nM30\n";
  const Order order{.machine = mill_with_reversal(), .text = text, .force = constant_force(milling())};
  Order alone = order;
  alone.in_batches = false;
  const Shop shop(order), slow(alone);
  const Compensation result = compensated(shop), single = compensated(slow);
  CHECK(largest_after(slow, single) < 5e-6);
  const auto places = [](const Compensation& of) {
    std::vector<Waypoint> list;
    for (const Waypoint& w : of.waypoints)
      if (w.place) list.push_back(w);
    return list;
  };
  const std::vector<Waypoint> a = places(result), b = places(single);
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK(a[i].directions == b[i].directions);
    CHECK((a[i].before - b[i].before).norm() < 1e-9);
  }
  for (const std::size_t moves : {1UL, 16UL}) {
    const WindowRun run = in_windows(order, moves);
    CHECK(run.windows > 1);
    CHECK(run.text == result.text);
  }
}

TEST_CASE("the linear and the nested method correct the same reversal") {
  for (const Method method : {Method::nested, Method::linear}) {
    const Shop shop({.machine = mill_with_reversal(), .text = corners, .method = method, .tolerance = 2e-6});
    CHECK(largest_after(shop, compensated(shop)) < 2e-6);
  }
}
