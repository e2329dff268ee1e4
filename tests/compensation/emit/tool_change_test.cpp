// Tools that bend, switched along a program.
#include "compensation/support/gantry.hpp"
#include "counterflex/machine/machine.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

constexpr double k1 = 10e6, k2 = 40e6;
const Vector3 force(200, -100, 30);

Tool radial(double k) {
  return {.from = ToolStiffness::radial, .yields = radial_tool(k)};
}

Machine with_two_tools(Machine machine) {
  machine.tools = {{1, radial(k1)}, {2, radial(k2)}};
  return machine;
}

Machine mill_with_two_tools() {
  return with_two_tools(read_machine(read_file(mill), "mill"));
}

/// The same lines with each tool, one after another.
std::string cut_with(const std::vector<int>& tools, int rows = 3) {
  std::string text = "G21 G90 G17 G54\n";
  for (const int tool : tools) {
    text += fmt::format("T{} M6\nG0 X10. Y10. Z0.\nG1 X60. F600\n", tool);
    for (int row = 1; row <= rows; ++row)
      text += fmt::format("Y{:.3f}\nX{}.\n", 10 + 15.0 * row / rows, row % 2 ? 10 : 60);
    text += "G2 X10. Y10. R40.\nG0 Z5.\n";
  }
  return text + "M30\n";
}

Order order_of(Machine machine, std::string text, double blend = 0) {
  Vector6 F = Vector6::Zero();
  F.head<3>() = force;
  Order order{.machine = std::move(machine), .text = std::move(text), .force = constant_force(F, blend)};
  order.decimals = 6;
  return order;
}

Order on_the_mill(std::string text, double blend = 0) {
  Order order = order_of(mill_with_two_tools(), std::move(text), blend);
  order.X_MW = order.machine.work.at("G54").X_MW;
  return order;
}

/// By which the end of the first feed move of every tool is shifted (m).
std::vector<Vector3> first_shifts(const Shop& shop, const Compensation& result) {
  std::vector<Vector3> shifts;
  std::size_t last = no_segment;
  for (const Waypoint& w : result.waypoints) {
    if (!w.cutting || w.between || w.fraction < 1) continue;
    const std::int32_t tool = shop.program.moves[shop.path.segments[w.segment].move].tool;
    if (static_cast<std::size_t>(tool) == last) continue;
    last = static_cast<std::size_t>(tool);
    shifts.emplace_back(w.correction.head<3>());
  }
  return shifts;
}

}  // namespace

TEST_CASE("each move is shifted by what its own tool bends: F/k of it, where nothing else deflects") {
  const Shop shop(order_of(with_two_tools(perfect_gantry()), cut_with({1, 2, 9, 1})));
  const auto shifts = first_shifts(shop, compensated(shop));
  REQUIRE(shifts.size() == 4);
  const Vector3 radial_force(force.x(), force.y(), 0);
  const double digit = 1e-9;
  CHECK((shifts[0] + radial_force / k1).norm() < digit);
  CHECK((shifts[1] + radial_force / k2).norm() < digit);
  CHECK(shifts[2].norm() < digit);  // not in [tools]
  CHECK((shifts[3] - shifts[0]).norm() < digit);
}

TEST_CASE("corrections of two tools differ by F/k1 and F/k2 on a machine that bends, too") {
  const Shop shop(on_the_mill(cut_with({1, 2})));
  const auto shifts = first_shifts(shop, compensated(shop));
  REQUIRE(shifts.size() == 2);
  const Vector3 expected = Vector3(force.x(), force.y(), 0) * (1 / k2 - 1 / k1);
  CHECK((shifts[0] - shifts[1] - expected).norm() < 1e-3 * expected.norm());
}

TEST_CASE("a program of several tools stays within the tolerance everywhere, by an independent judge") {
  for (const double blend : {0.0, 2e-3}) {
    CAPTURE(blend);
    const Shop shop(on_the_mill(cut_with({1, 2, 1}), blend));
    const Compensation result = compensated(shop);
    const Miss worst = dense_miss(shop, result, 5);
    CAPTURE(worst.line);
    CHECK(worst.size < shop.options.tolerance);
  }
}

TEST_CASE("verify accepts what was compensated for its tools, and refuses what was for others") {
  Order order = on_the_mill(cut_with({1, 2}), 2e-3);
  const std::string text = compensated(Shop(order)).text;
  CHECK(refusal_of(Shop(order), text).empty());
  std::swap(order.machine.tools[1], order.machine.tools[2]);
  CHECK(refusal_of(Shop(order), text).starts_with("verification failed: the tip misses the path by 0.0"));
  order.machine.tools.clear();
  CHECK_FALSE(refusal_of(Shop(order), text).empty());
}

TEST_CASE("with several tools, too, the bytes do not depend on the number of threads" *
          doctest::test_suite("long")) {
  Order order = on_the_mill(cut_with({1, 2, 1, 7, 2}, 40), 2e-3);
  const Compensation one = compensated(Shop(order), true);
  order.threads = 3;
  const Compensation three = compensated(Shop(order), true);
  CHECK(one.text == three.text);
  REQUIRE(one.waypoints.size() == three.waypoints.size());
  bool same = true;
  for (std::size_t i = 0; i < one.waypoints.size(); ++i)
    same = same && one.waypoints[i].after == three.waypoints[i].after &&
           (!knows_before(one.waypoints[i]) ||
            (one.waypoints[i].causes->load == three.waypoints[i].causes->load &&
             one.waypoints[i].causes->air == three.waypoints[i].causes->air));
  CHECK(same);
}

TEST_CASE("tools of a length alone change no byte") {
  Order order = on_the_mill(cut_with({1, 2}), 2e-3);
  order.machine.tools.clear();
  const std::string without = compensated(Shop(order)).text;
  order.machine.tools = {{1, {.length = 0.05}}, {2, {.length = 0.15}}};
  CHECK(compensated(Shop(order)).text == without);
}

TEST_CASE(
    "where a change of tool moves no axis, a feed move behind it begins with a jump to its own correction") {
  std::string text = "G21 G90 G17 G54\nT1 M6\nG0 X10. Y10. Z0.\nG1 X60. F600\nY20.\nT2 M6\nX10.\nY30.\n";
  Order order = on_the_mill(text + "T1 M6\nX60.\nM30\n");
  order.read.tool_change_moves.emplace();
  const Shop shop(order);
  const Compensation result = compensated(shop);
  const Miss worst = dense_miss(shop, result, 5);
  CAPTURE(worst.line);
  CHECK(worst.size < shop.options.tolerance);
  CHECK(result.counts.inserted_blocks >= 2);
  CHECK(refusal_of(shop, result.text).empty());
}

TEST_CASE("a head that leans shifts a longer tool by more: first positions, holes and cuts") {
  const double lean = 1e-3;
  Machine machine = read_machine(fmt::format(R"(format = "counterflex-machine 1"
controlled = ["x", "y", "z"]
[spindle]
xyz_mm = [0, 0, -20]
[tools.T1]
length_mm = 80
[tools.T2]
length_mm = 180
[[chain]]
name = "axes"
elements = [
  {{ actuator = "prismatic", axis = "x" }},
  {{ actuator = "prismatic", axis = "y" }},
  {{ actuator = "prismatic", axis = "z" }},
  {{ error = "head" }},
]
errors.head = {{ rpy_deg = [0, {}, 0] }}
)",
                                             lean / deg),
                                 "head.toml");
  const std::string moves = "G0 X10. Y10. Z5.\nG98 G81 X20. Z-3. R1. F100\nG80\nG1 X30. F600\nG0 Z5.\n";
  const Shop shop(
      {.machine = machine, .text = "G21 G90 G17\nT1 M6\n" + moves + "T2 M6\n" + moves, .decimals = 6});
  const Compensation result = compensated(shop);
  CHECK(refusal_of(shop, result.text).empty());
  std::size_t first = 0, second = 0;
  const auto shift_is = [](const Waypoint& w, double L) {
    return std::abs(w.correction[0] - std::sin(1e-3) * L) < 1e-9;
  };
  for (const Waypoint& w : result.waypoints)
    (w.line < 9 ? first : second) += shift_is(w, w.line < 9 ? 0.1 : 0.2);
  CHECK(first + second == result.waypoints.size());
  CHECK(first >= 3);
  CHECK(second >= 3);
}
