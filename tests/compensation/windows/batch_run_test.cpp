// Runs whose waypoints are solved side by side are the runs whose waypoints are solved one by one.
#include "compensation/support/gantry.hpp"
#include "counterflex/machine/machine.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

void check_same_waypoints(const Compensation& a, const Compensation& b) {
  REQUIRE(a.waypoints.size() == b.waypoints.size());
  for (std::size_t i = 0; i < a.waypoints.size(); ++i) {
    const Waypoint &x = a.waypoints[i], &y = b.waypoints[i];
    CAPTURE(x.line);
    CAPTURE(x.fraction);
    CHECK(x.line == y.line);
    CHECK(x.status == y.status);
    CHECK(std::abs(x.fraction - y.fraction) <= 1e-9);
    CHECK((x.correction - y.correction).cwiseAbs().maxCoeff() <= 1e-9);
    CHECK((x.before - y.before).cwiseAbs().maxCoeff() <= 1e-9);
    CHECK((x.after - y.after).cwiseAbs().maxCoeff() <= 1e-9);
  }
}

// The result of lanes, for more to check.
Compensation check_same_run(const Order& order, bool attribution = false) {
  const Shop shop(order);
  const StartTables starts;
  Job job = shop.job();
  const Compensation alone = compensate(job, attribution);
  job.starts = &starts;
  Compensation together = compensate(job, attribution);
  REQUIRE(alone.failure.has_value() == together.failure.has_value());
  if (alone.failure) {
    CHECK(alone.failure->line == together.failure->line);
    CHECK(alone.failure->kind == together.failure->kind);
    CHECK(alone.failure->what == together.failure->what);
  } else {
    CHECK(std::abs(largest_correction(alone.waypoints).size - largest_correction(together.waypoints).size) <=
          1e-9);
  }
  check_same_waypoints(alone, together);
  return together;
}

const char* const long_line = "G21 G90\nG0 X-73.65 Y-73.65 Z-73.65\nG1 Y126.35 F600\nG1 X60. Y20.\nM30\n";

}  // namespace

TEST_CASE("long lines are compensated side by side as they are one by one, forces or none" *
          doctest::test_suite("long")) {
  for (const auto& [machine, blend] :
       {std::pair{orthoglide_a, 0.0}, {orthoglide_b, 2e-3}, {orthoglide_perfect, 0.0}}) {
    const auto& shown = machine;
    CAPTURE(shown);
    const Order order{
        .machine = load_machine(machine), .text = long_line, .force = constant_force(milling(), blend)};
    CHECK(!check_same_run(order).failure);
  }
  CHECK(!check_same_run({.machine = load_machine(orthoglide_b), .text = long_line}).failure);
}

TEST_CASE("causes are distinguished side by side as they are one by one") {
  const Order order{.machine = load_machine(orthoglide_b),
                    .text = "G21 G90\nG0 X0. Y0. Z0.\nG1 X10. F600\nG1 Y10.\nM30\n",
                    .force = constant_force(milling())};
  const Shop shop(order);
  const StartTables starts;
  Job job = shop.job();
  const Compensation alone = compensate(job, true);
  job.starts = &starts;
  const Compensation together = compensate(job, true);
  check_same_waypoints(alone, together);
  int told = 0;
  for (std::size_t i = 0; i < alone.waypoints.size(); ++i) {
    if (!knows_before(alone.waypoints[i])) continue;
    const Causes &x = *alone.waypoints[i].causes, &y = *together.waypoints[i].causes;
    for (const auto cause : {&Causes::geometry, &Causes::load, &Causes::superposition, &Causes::air})
      CHECK((x.*cause - y.*cause).cwiseAbs().maxCoeff() <= 1e-9);
    told += !x.load.isZero(1e-6);
  }
  CHECK(told >= 3);
}

TEST_CASE("arcs, a ramp and rapids of a sample are compensated side by side as they are one by one") {
  const Order order{
      .machine = load_machine(orthoglide_b), .text = read_file(groove), .force = constant_force(milling())};
  CHECK(check_same_run(order).waypoints.size() > 50);
}

TEST_CASE(
    "machines that control orientations too, and serial ones, are compensated side by side as one by one") {
  const Order legs{.machine = load_machine(hexapod),
                   .text = "G21 G90\nG0 X0. Y0. Z850.\nG1 X40. Y10. Z870. F100\nG1 X0. Y0.\nM30\n",
                   .force = constant_force(milling())};
  CHECK(!check_same_run(legs).failure);
  const Order axes{.machine = load_machine(mill),
                   .text = "G21 G90\nG0 X10. Y10. Z-240.\nG1 X150. F100\nG1 Y90.\nM30\n",
                   .force = constant_force(milling())};
  CHECK(!check_same_run(axes).failure);
  CHECK(!check_same_run({.machine = displaced_gantry(),
                         .text = "G21 G90\nG0 X0 Y0 Z0\nG1 X500 F100\nG2 X0 Y0 I-250 J0\nM30\n"})
             .failure);
}

TEST_CASE("each tool's moves are compensated side by side as they are one by one") {
  Order order{.machine = load_machine(mill),
              .text =
                  "G21 G90\nT1 M6\nG0 X10. Y10. Z-240.\nG1 X60. F600\nY25.\nX10.\nT2 M6\nG1 X60.\nY40.\n"
                  "T1 M6\nG1 X20.\nM30\n",
              .force = constant_force((Vector6() << 200, -100, 30, 0, 0, 0).finished())};
  for (const auto& [number, stiffness] : {std::pair{1, 10e6}, {2, 40e6}})
    order.machine.tools[number] = {.from = ToolStiffness::radial, .yields = radial_tool(stiffness)};
  const Compensation together = check_same_run(order);
  CHECK(!together.failure);
  order.machine.tools.clear();
  CHECK((together.waypoints.back().correction - check_same_run(order).waypoints.back().correction).norm() >
        1e-5);
}

TEST_CASE("the nested method finds side by side what it finds one by one") {
  CHECK(!check_same_run({.machine = load_machine(orthoglide_b),
                         .text = "G21 G90\nG0 X0. Y0. Z0.\nG1 X10. F600\nG1 Y10.\nM30\n",
                         .force = constant_force(milling()),
                         .method = Method::nested})
             .failure);
}

TEST_CASE("a program refused one by one is refused side by side, at the same line in the same words") {
  const char* const far_right = "G21 G90\nG0 X10. Y10. Z-240.\nG0 X399.5\nG1 X400.3 F100\nM30\n";
  CHECK(check_same_run({.machine = load_machine(mill), .text = far_right}).failure);
  const char* const above = "G21 G90\nG0 X10. Y10. Z-100.\nM30\n";
  CHECK(check_same_run({.machine = load_machine(mill), .text = above}).failure);
  const char* const long_legs = "G21 G90\nG0 X0. Y0. Z850.\nG1 Z1100. F100\nG1 Z1500.\nM30\n";
  CHECK(check_same_run({.machine = load_machine(hexapod), .text = long_legs}).failure);
  const char* const unreachable = "G21 G90\nG0 X0. Y0. Z0.\nG0 X10.\nG1 X900. F600\nM30\n";
  CHECK(check_same_run({.machine = load_machine(orthoglide_b), .text = unreachable}).failure);
  const char* const there_and_back =
      "G21 G90\nG0 X0. Y0. Z0.\nG2 X40. Y0. I20. J300. F600\nG1 X900. F600\nG1 X0.\nM30\n";
  CHECK(check_same_run({.machine = load_machine(orthoglide_b), .text = there_and_back}).failure);
  const char* const through_axis_1 = "G21 G90\nG0 X600. Y900. Z800.\nG0 X120.\nG1 Y-900. F600\nM30\n";
  CHECK(check_same_run({.machine = load_machine(robot), .text = through_axis_1}).failure);
  Order little{.machine = load_machine(orthoglide_b), .text = long_line, .force = constant_force(milling())};
  little.max_correction = 0.2e-3;
  CHECK(check_same_run(little).failure);
}

TEST_CASE("a load that the machine cannot carry is refused side by side as it is one by one") {
  Order order{.machine = load_machine(orthoglide_b),
              .text = "G21 G90\nG0 X0. Y0. Z0.\nG1 X5. F600\nG1 X10.\nM30\n"};
  order.max_correction = 0.1;
  for (const double force : {1500.0, 2500.0}) {
    CAPTURE(force);
    order.force = constant_force(force * Vector6::Unit(0), 0);
    CHECK(check_same_run(order).failure.has_value() == (force == 2500.0));
  }
}
