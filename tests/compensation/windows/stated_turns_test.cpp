// T of a KUKA target states the sign of each rotary axis. A corrected target keeps it.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <array>
#include <string>

#include "compensation/support/arm.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

Order order_of(double y_mm, const std::string& turns) {
  Order order{.machine = arm_machine(),
              .text = fmt::format("DEF job()\n"
                                  "PTP {{X 1750.0,Y {0:.4f},Z 640.0,A 0.0,B 0.0,C 0.0{1}}}\n"
                                  "LIN {{X 1750.0,Y {0:.4f},Z 600.0,A 0.0,B 0.0,C 0.0}}\n"
                                  "END\n",
                                  y_mm, turns)};
  order.force = constant_force((Vector6() << 120, -300, -80, 2, 5, -3).finished());
  order.max_correction = 20e-3;
  order.read.dialect = "kuka";
  return order;
}

/// Whether each axis of the arm without errors is negative at the end of the first move. A zero that is
/// rounded is not.
std::array<bool, 6> signs_of(const Program& program) {
  const Move& move = program.moves.front();
  const auto& angles = move.orientation->end;
  const Arm::Joints q =
      Arm{}.inverse(homogeneous(move.end_mm * mm, rotation_of_words({angles[0], angles[1], angles[2]})));
  std::array<bool, 6> negative{};
  for (std::size_t i = 0; i < 6; ++i) negative[i] = q[static_cast<Eigen::Index>(i)] < -1e-9;
  return negative;
}

}  // namespace

TEST_CASE("of 100 targets beside the zero of an axis none changes the sign that T states") {
  int refused = 0, written = 0;
  for (int k = 0; k < 100; ++k) {
    const double y_mm = -0.2475 + 0.005 * k;
    CAPTURE(y_mm);
    const Order order = order_of(y_mm, ",S 2,T 10");
    Shop shop(order);
    const Compensation result = compensate(shop.job(), false);
    if (result.failure) {
      ++refused;
      CHECK(result.failure->line == 2);
      CHECK(result.failure->what.find("across zero, but T of the target states its sign") !=
            std::string::npos);
      continue;
    }
    ++written;
    const Program corrected = read_program(result.text, "out.src", order.read);
    CHECK(signs_of(shop.program) == signs_of(corrected));
  }
  CHECK(refused > 0);
  CHECK(written >= 50);
}

TEST_CASE("a target without T may cross the zero of an axis, and a crossing is found in a finished program") {
  int crossed = 0;
  for (int k = 0; k < 100; ++k) {
    const double y_mm = -0.2475 + 0.005 * k;
    Shop free(order_of(y_mm, ""));
    const Compensation result = compensate(free.job(), false);
    REQUIRE(!result.failure);
    const Program corrected = read_program(result.text, "out.src", free.read);
    if (signs_of(free.program) == signs_of(corrected)) continue;
    ++crossed;
    Shop stated(order_of(y_mm, ",S 2,T 10"));
    std::string text = result.text;
    text.insert(text.find('}'), ",S 2,T 10");
    const auto failure = verify(stated.job(), read_program(text, "out.src", stated.read), false).failure;
    REQUIRE(failure);
    CHECK(failure->what.find("across zero") != std::string::npos);
  }
  CHECK(crossed > 0);
}

TEST_CASE("the sign that T states is of the value that the control shows") {
  std::string text = read_file(robot);
  text = replaced(text, "xyz_mm = [250, 0, 120]", "xyz_mm = [250, 0, 120]\nrpy_deg = [0, -90, 0]");
  for (const std::string axis : {"z", "x"}) {
    const std::string joint = "actuator = \"revolute\", axis = \"" + axis + "\" }";
    for (std::size_t at = 0; (at = text.find(joint, at)) != std::string::npos; at += joint.size())
      text.insert(at + joint.size() - 2, ", shown_zero_deg = 20");
  }
  for (int k = 0; k < 100; ++k) {
    const double y_mm = -0.2475 + 0.005 * k;
    CAPTURE(y_mm);
    Order order = order_of(y_mm, ",S 2,T 10");
    order.machine = read_machine(text, "arm.toml");
    Shop shop(order);
    CHECK(!compensate(shop.job(), false).failure);
  }
}
