#include <doctest/doctest.h>
#include <fmt/format.h>

#include "compensation/support/busy_program.hpp"
#include "compensation/support/gantry.hpp"
#include "compensation/support/window_run.hpp"
#include "counterflex/geometry/pose.hpp"
#include "counterflex/machine/machine.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// Answers do not depend on windows. Forces may, by rounding: their path is added up in another order.
void check_same(const WindowRun& parts, const WindowRun& whole) {
  CHECK(parts.text == whole.text);
  CHECK(parts.inserted == whole.inserted);
  CHECK(parts.corrected == whole.corrected);
  CHECK(largest_correction(parts.waypoints).size ==
        doctest::Approx(largest_correction(whole.waypoints).size).epsilon(1e-6));
  REQUIRE(parts.left_alone.size() == whole.left_alone.size());
  for (std::size_t i = 0; i < whole.left_alone.size(); ++i) {
    CHECK(parts.left_alone[i].line == whole.left_alone[i].line);
    CHECK(parts.left_alone[i].why == whole.left_alone[i].why);
  }
  REQUIRE(parts.waypoints.size() == whole.waypoints.size());
  for (std::size_t i = 0; i < whole.waypoints.size(); ++i) {
    const Waypoint &a = parts.waypoints[i], &b = whole.waypoints[i];
    CAPTURE(b.line);
    CAPTURE(b.fraction);
    CHECK(a.line == b.line);
    CHECK(a.fraction == doctest::Approx(b.fraction).epsilon(1e-9));  // p_MT is closer
    CHECK(a.s == doctest::Approx(b.s).epsilon(1e-12));
    CHECK((a.p_MT - b.p_MT).norm() < 1e-12);
    CHECK((a.wrench - b.wrench).norm() < 1e-9 * (1 + b.wrench.norm()));
    const double room = a.wrench == b.wrench && a.p_MT == b.p_MT && a.correction == b.correction ? 0 : 1e-10;
    CHECK((a.after - b.after).norm() <= room);
    CHECK((a.before - b.before).norm() <= room);
  }
}

}  // namespace

TEST_CASE("a program compensated in windows is the same program, to the byte") {
  for (const double blend : {2e-3, 0.0}) {
    Order order = on_mill(busy_program());
    order.force = constant_force({40, -25, 15, 0, 0, 0}, blend);
    WriteOptions write;
    write.header = {"COUNTERFLEX 1 TEST"};
    const WindowRun whole = in_windows(order, whole_program, write);
    if (whole.failure) FAIL(whole.failure->what);
    REQUIRE(whole.windows == 1);
    for (const std::size_t least_moves : {1, 4, 15}) {
      CAPTURE(least_moves);
      const WindowRun parts = in_windows(order, least_moves, write);
      CHECK(parts.windows >= 30 / least_moves + 1);
      CHECK(!parts.failure);
      check_same(parts, whole);
    }
  }
}

TEST_CASE("blocks of a few digits are verified at every end of a window, with a jump there and without one") {
  for (const double blend : {2e-3, 0.0}) {
    std::string text = "G21 G90\nG0 X20. Y0. Z0.\nG1 X40. F600\n";
    for (const char* block : {"X40.001", "X40.002", "X40.003", "X80.", "G0 X20.", "G1 X20.001", "X20.002",
                              "Y0.001", "X20.003 Y0.", "X60.", "X60.002", "G0 Z20."})
      text += std::string(block) + "\n";
    Order order = on_mill(text);
    order.force = constant_force({40, -25, 15, 0, 0, 0}, blend);
    const WindowRun whole = in_windows(order, whole_program);
    REQUIRE(!whole.failure);
    for (const std::size_t least_moves : {1, 2, 3, 8, 9, 10, 17, 18}) {
      CAPTURE(least_moves);
      const WindowRun parts = in_windows(order, least_moves);
      CHECK(parts.windows > 1);
      CHECK((parts.failure ? parts.failure->what : "") == "");
      check_same(parts, whole);
    }
  }
}

TEST_CASE("a block that is not followed is refused with the same reason in windows") {
  Order order = on_mill("G21 G90\nG0 X0 Y0 Z0\nG1 X10 F600\nX20\nX40\nX[30+20] Y20\nX80 Y30\n");
  order.force = constant_force({40, -25, 15, 0, 0, 0});
  const WindowRun whole = in_windows(order, whole_program);
  REQUIRE(whole.failure);
  for (std::size_t least_moves = 1; least_moves < 10; ++least_moves) {
    CAPTURE(least_moves);
    const WindowRun parts = in_windows(order, least_moves);
    REQUIRE(parts.failure);
    CHECK(parts.failure->line == whole.failure->line);
    CHECK(parts.failure->what == whole.failure->what);
  }
}

TEST_CASE("a wrench of its own on every line acts the same in windows, in the feed frame, too") {
  std::string rows = "# frame = feed\n# sense = on_tool\nline,fx_N,fy_N,fz_N\n";
  for (int line = 1; line <= 90; ++line)
    rows += fmt::format("{},{},{},{}\n", line, line % 37, -(line % 23), 5);
  Order order = on_mill(busy_program());
  order.force.rules = read_force_csv(rows, "forces.csv");
  const WindowRun whole = in_windows(order, whole_program), parts = in_windows(order, 3);
  if (whole.failure) FAIL(whole.failure->what);
  CHECK(parts.windows > 10);
  check_same(parts, whole);
}

TEST_CASE("a parallel machine keeps its branch from window to window") {
  std::string text = "G21 G90 G17\nG0 X0 Y0 Z0\nG1 F600\n";
  for (int k = 1; k <= 40; ++k) text += fmt::format("X{} Y{}\n", 2 * k, (k * 7) % 30);
  const Order order{.machine = read_machine(read_file(orthoglide_b), "b"),
                    .text = text,
                    .force = constant_force(milling()),
                    .tolerance = 20e-6};
  const WindowRun whole = in_windows(order, whole_program), parts = in_windows(order, 5);
  if (whole.failure) FAIL(whole.failure->what);
  CHECK(parts.windows >= 7);
  check_same(parts, whole);
}

TEST_CASE("windows keep the tool that is in the spindle, and its model") {
  for (const std::string& file : {mill, orthoglide_b}) {
    CAPTURE(file);
    std::string text = "G21 G90 G17\nG0 X0 Y0 Z0\n";
    for (int k = 1; k <= 40; ++k) {
      if (k % 9 == 0) text += fmt::format("T{} M6\nG0 X{} Y0 Z2\n", k % 4, k);
      text += fmt::format("G1 X{} Y{} F600\n", k, (k * 7) % 30);
    }
    Order order{.machine = read_machine(read_file(file), "machine"),
                .text = text,
                .force = constant_force(milling()),
                .tolerance = 20e-6};
    if (file == mill) order.X_MW = order.machine.work.at("G54").X_MW;
    order.machine.X_PS = order.machine.X_PT;
    order.machine.tools = {
        {1, {.from = ToolStiffness::radial, .yields = radial_tool(8e6)}},
        {2, {.length = 0.05}},
        {3, {.length = 0.02, .yields = {cantilever_tool(0.01, 0.03, ToolMaterial::steel)}}}};
    const WindowRun whole = in_windows(order, whole_program);
    if (whole.failure) FAIL(whole.failure->what);
    for (const std::size_t least_moves : {1, 7}) {
      const WindowRun parts = in_windows(order, least_moves);
      CHECK(parts.windows > 4);
      check_same(parts, whole);
    }
  }
}

TEST_CASE("forces in the tool's axes turn with [spindle] as with a [tool] of the same orientation") {
  Order order{.machine = read_machine(read_file(COUNTERFLEX_SOURCE_DIR "/samples/robot-spindle/machine.toml"),
                                      "machine"),
              .text = "G21 G90 G17\nT1 M6\nG0 X0 Y0 Z0\nG1 X20 F600\nY15\nX5 Y5\n",
              .force = constant_force(milling()),
              .tolerance = 20e-6,
              .max_correction = 20e-3};
  order.X_MW = order.machine.work.at("G54").X_MW;
  std::get<ConstantForce>(order.force.rules[0].content).frame = ForceFrame::tool;
  order.machine.gravity = {};
  const Pose X_PS = order.machine.X_PT * Pose{exp_so3(Vector3(0.4, -0.2, 0.1)), {0.01, 0, 0.02}};
  Order with_tip = order;
  order.machine.X_PS = X_PS;
  order.machine.tools = {{1, {.length = 0.05}}};
  with_tip.machine.X_PT = X_PS * Pose{Matrix3::Identity(), {0, 0, -0.05}};
  const WindowRun run = in_windows(order, whole_program), expected = in_windows(with_tip, whole_program);
  if (run.failure) FAIL(run.failure->what);
  REQUIRE_FALSE(expected.failure);
  CHECK(largest_correction(expected.waypoints).size > 20e-6);
  check_same(run, expected);
}

TEST_CASE("a window that cannot be compensated gives the line, and those before it are done") {
  std::string text = "G21 G90 G17\nG0 X0 Y0 Z0\nG1 F600\n";
  for (int k = 1; k <= 20; ++k) text += fmt::format("X{}\n", k);
  const Order order = on_mill(text + "X99999\nX1\n");
  const WindowRun run = in_windows(order, 4);
  REQUIRE(run.failure);
  CAPTURE(run.failure->what);
  CHECK(run.failure->line == 24);
  CHECK(run.failure->kind == ErrorKind::limit);
  CHECK(run.windows >= 5);
  CHECK_FALSE(run.text.empty());
}
