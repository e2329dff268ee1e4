// Moves that turn the tool of a six-axis machine much and move its tip little or not at all.
#include "compensation/support/shop.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

Order turning_order(const std::string& text, double tolerance) {
  Order order{.machine = load_machine(robot), .text = text};
  order.max_correction = 20e-3;
  order.tolerance = tolerance;
  order.X_MW = translation({1.75, 0.05, 0.6});
  order.read.dialect = "linuxcnc";
  order.read.tool_orientation = true;
  return order;
}

std::string refusal(const Shop& shop, const Program& written) {
  const auto failure = verify(shop.job(), written, false).failure;
  return failure ? failure->what : "";
}

/// The program is compensated, and accepted with larger tolerances too.
void check_right(const Order& order) {
  Shop shop(order);
  const Program written = read_program(compensated(shop).text, "out.ngc", order.read);
  for (const double times : {1.0, 1.2, 1.5, 2.0, 4.0, 10.0}) {
    CAPTURE(times);
    shop.options.tolerance = times * order.tolerance;
    CHECK(refusal(shop, written) == "");
  }
}

constexpr char short_ways[] =
    "G21 G90 G17 G94\nG0 X60 Y40 Z60 A0 B0 C0\nG0 X10 Y40 Z10 B-8\nG1 Z0 F300\nG1 X60 Y10 A8 B0 F1200\n"
    "G1 X60.01 A-8\nG1 X60.1 Y10.05 B-8\nG1 X60.6 A8 B8\nG1 X60.7 A-12\nG1 X110 Y40 A0 B8\n"
    "G1 X110.02 Y40.02 A8 B-8\nG0 Z60\nM30\n";

}  // namespace

TEST_CASE("what turns much and goes a short way is verified with any tolerance") {
  for (const double tolerance : {2e-6, 5e-6, 20e-6}) {
    CAPTURE(tolerance);
    Order order = turning_order(short_ways, tolerance);
    order.force = constant_force((Vector6() << 120, -300, -80, 2, 5, -3).finished());
    check_right(order);
  }
}
