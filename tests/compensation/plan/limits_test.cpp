// Runs that are refused, each with its exit status and the line.
#include <fmt/format.h>

#include "compensation/support/judge.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

Failure refused(const Order& order) {
  const Compensation result = Shop(order).run();
  REQUIRE(result.failure);
  CHECK(result.text.empty());
  return *result.failure;
}

const char* const cuts = "G21 G90\nG0 X0. Y0. Z0.\nG1 X10. F600\nG1 Y100.\nM30\n";

}  // namespace

TEST_CASE("a correction above the limit is refused at its line") {
  Order order{.machine = load_machine(orthoglide_b), .text = cuts, .force = constant_force(milling())};
  order.decimals = 6;
  const auto [size, line] = largest_correction(compensated(Shop(order)).waypoints);
  const double rounding = 1e-9;  // of the written words: the limit holds before they are rounded
  order.max_correction = size + rounding;
  CHECK(!Shop(order).run().failure);
  order.max_correction = size - rounding;
  const Failure failure = refused(order);
  CHECK(failure.kind == ErrorKind::limit);
  CHECK(failure.line == line);
  CHECK(failure.what.find("limit") != std::string::npos);
}

TEST_CASE("the limit holds for the first position too") {
  Order order{.machine = load_machine(orthoglide_b), .text = "G21 G90\nG0 X0. Y-60. Z0.\nM30\n"};
  order.max_correction = 1e-4;
  const Failure failure = refused(order);
  CHECK(failure.kind == ErrorKind::limit);
  CHECK(failure.line == 2);
}

TEST_CASE("a first position counts among the corrections") {
  const Compensation result =
      compensated(Shop({.machine = load_machine(orthoglide_b), .text = "G21 G90\nG0 X0. Y-60. Z0.\nM30\n"}));
  CHECK(largest_correction(result.waypoints).size > 1e-4);
  CHECK(largest_correction(result.waypoints).line == 2);
}

TEST_CASE("an actuator that leaves its travel is a limit, whether the machine gets positions or poses") {
  Order order{.machine = load_machine(mill),
              .text = "G21 G90\nG0 X10. Y10. Z-240.\nG0 X399.5\nG1 X400.3 F100\nM30\n"};
  Failure failure = refused(order);
  CHECK(failure.kind == ErrorKind::limit);
  CHECK(failure.line == 4);
  order.text = "G21 G90\nG0 X10. Y10. Z-100.\nM30\n";  // the spindle nose would be above its travel
  failure = refused(order);
  CHECK(failure.kind == ErrorKind::limit);
  CHECK(failure.line == 2);
  // Legs of the hexapod end at 500 mm: 1200 mm long.
  order.machine = load_machine(hexapod);
  order.text = "G21 G90\nG0 X0. Y0. Z850.\nG1 Z1100. F100\nG1 Z1500.\nM30\n";
  failure = refused(order);
  CHECK(failure.kind == ErrorKind::limit);
  CHECK(failure.line == 4);
}

TEST_CASE("the linear method respects travel as well") {
  const Failure failure = refused({.machine = load_machine(mill),
                                   .text = "G21 G90\nG0 X10. Y10. Z-240.\nG0 X450.\nM30\n",
                                   .method = Method::linear});
  CHECK(failure.kind == ErrorKind::limit);
  CHECK(failure.line == 3);
}

TEST_CASE("a place that the machine does not reach is not compensated") {
  const Failure failure = refused({.machine = load_machine(orthoglide_b),
                                   .text = "G21 G90\nG0 X0. Y0. Z0.\nG0 X10.\nG1 X900. F600\nM30\n"});
  CHECK(failure.kind == ErrorKind::not_compensated);
  CHECK(failure.line == 4);
}

TEST_CASE("a machine that buckles under the load is not compensated") {
  Order order{.machine = load_machine(strut),
              .text = "G21 G90\nG0 X400. Y0. Z0.\nG1 X401. F100\nG1 X402.\nM30\n"};
  order.force = constant_force((Vector6() << -4900, 0, 0, 0, 0, 0).finished(), 0);
  CHECK(!Shop(order).run().failure);
  order.force = constant_force((Vector6() << -5100, 0, 0, 0, 0, 0).finished(), 0);
  const Failure failure = refused(order);
  CHECK(failure.kind == ErrorKind::not_compensated);
  CHECK(failure.line == 3);
  CHECK(failure.what.find("unstable") != std::string::npos);
}

TEST_CASE("too few decimals for the tolerance are a matter of usage") {
  Order order{.machine = load_machine(orthoglide_b), .text = cuts, .force = constant_force(milling())};
  order.decimals = 2;
  CHECK(refused(order).kind == ErrorKind::usage);
  order.decimals = -1;
  order.tolerance = 0.9e-6;  // rounding takes 0.866 um of it, and the tip moves a little more than its target
  const Compensation result = Shop(order).run();
  if (result.failure)
    CHECK(result.failure->kind == ErrorKind::usage);
  else
    CHECK(dense_miss(Shop(order), result, 10).size <= 0.9e-6);
}

TEST_CASE(
    "the allowance for rounding is half the last digit times the root of three, in the unit of the program") {
  const Program metric = read_program("G21 G90\nG0 X1. Y1. Z1.\nG1 X2.00005 F1\n", "a", {});
  CHECK(rounding_allowance(metric.moves[0], {}) == doctest::Approx(0.5e-6 * std::sqrt(3.0)));
  CHECK(rounding_allowance(metric.moves[0], {.decimals = 5, .header = {}}) ==
        doctest::Approx(0.5e-8 * std::sqrt(3.0)));
  const Program inches = read_program("G20 G90\nG0 X1. Y1. Z1.\n", "a", {});
  CHECK(rounding_allowance(inches.moves[0], {}) == doctest::Approx(0.5e-4 * 25.4e-3 * std::sqrt(3.0)));
}
