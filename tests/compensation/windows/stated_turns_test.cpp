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

Order job_of(const std::string& dialect, std::string text, const Machine& machine) {
  Order order = order_of(0, "");
  order.machine = machine;
  order.text = std::move(text);
  order.read.dialect = dialect;
  return order;
}

std::string abb_job(double y_mm, const std::string& state) {
  return fmt::format(
      "MODULE part\nPROC main()\n{0}"
      "MoveJ [[1750,{1:.4f},640],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v25,z1,tool0;\n"
      "MoveL [[1750,{1:.4f},600],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v25,z1,tool0;\n"
      "ENDPROC\nENDMODULE\n",
      state, y_mm);
}

std::string fanuc_job(double y_mm) {
  const std::string position =
      "P[{0}]{{\n   GP1:\n UF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0',\n X = 1750.0000 mm, Y = {1:.4f} mm, "
      "Z = {2:.4f} mm,\n W = 0.0000 deg, P = 0.0000 deg, R = 0.0000 deg\n}};\n";
  return "/PROG part\n/MN\n1:J P[1] 50% FINE ;\n2:L P[2] 25mm/sec CNT100 ;\n/POS\n" +
         fmt::format(fmt::runtime(position), 1, y_mm, 640.0) +
         fmt::format(fmt::runtime(position), 2, y_mm, 600.0) + "/END\n";
}

std::string yaskawa_job(double y_mm) {
  return fmt::format(
      "/JOB\n//POS\n///NPOS 2,0,0,0,0,0\n///POSTYPE BASE\n///RECTAN\n///RCONF 1,0,0,0,0,0\n"
      "C00000=1750.0000,{0:.4f},640.0000,0.0000,0.0000,0.0000\n"
      "C00001=1750.0000,{0:.4f},600.0000,0.0000,0.0000,0.0000\n"
      "//INST\nNOP\nMOVJ C00000 VJ=5.00\nMOVL C00001 V=25.0\nEND\n",
      y_mm);
}

/// Of 100 targets beside the zero of axis 1, the number that is refused with these words.
template <typename JobAt>
int refused_beside_zero(const JobAt& job_at, const std::string& words) {
  int refused = 0;
  for (int k = 0; k < 100; ++k) {
    Shop shop(job_at(-0.2475 + 0.005 * k));
    const Compensation result = compensate(shop.job(), false);
    if (!result.failure) continue;
    CAPTURE(result.failure->what);
    CHECK(result.failure->what.find(words) != std::string::npos);
    ++refused;
  }
  return refused;
}

/// The arm whose control shows these values (deg) for axes 1, 4 and 6 where they are at zero.
Machine arm_that_shows(int zero_deg) {
  std::string text = arm_text();
  for (const std::string axis : {"z", "x"}) {
    const std::string joint = "actuator = \"revolute\", axis = \"" + axis + "\" }";
    for (std::size_t at = 0; (at = text.find(joint, at)) != std::string::npos; at += joint.size())
      text.insert(at + joint.size() - 2, fmt::format(", shown_zero_deg = {}", zero_deg));
  }
  return read_machine(text, "arm.toml");
}

}  // namespace

TEST_CASE("MoveJ of ABB keeps the quadrants of axes 1, 4 and 6, unless ConfJ is off") {
  const auto jobs = [](const std::string& state) {
    return [state](double y_mm) { return job_of("abb", abb_job(y_mm, state), arm_machine()); };
  };
  const std::string words = "a multiple of 90 deg, but confdata of the target states its quadrant";
  const int refused = refused_beside_zero(jobs(""), words);
  CHECK(refused > 0);
  CHECK(refused <= 50);
  CHECK(refused_beside_zero(jobs("ConfL\\Off;\n"), words) == refused);
  CHECK(refused_beside_zero(jobs("ConfJ\\Off;\n"), words) == 0);
}

TEST_CASE("joint moves of FANUC and Yaskawa keep the turns of axes 1, 4 and 6") {
  const std::string words = "180 deg, but the configuration of the target states its turn";
  const auto refused = [&](const Machine& machine) {
    return std::array{
        refused_beside_zero([&](double y_mm) { return job_of("fanuc_tp", fanuc_job(y_mm), machine); }, words),
        refused_beside_zero([&](double y_mm) { return job_of("yaskawa", yaskawa_job(y_mm), machine); },
                            words)};
  };
  CHECK(refused(arm_machine()) == std::array{0, 0});
  const auto [fanuc, yaskawa] = refused(arm_that_shows(180));
  CHECK(fanuc > 0);
  CHECK(fanuc <= 50);
  CHECK(yaskawa == fanuc);
}

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
  const Machine machine = arm_that_shows(20);
  for (int k = 0; k < 100; ++k) {
    const double y_mm = -0.2475 + 0.005 * k;
    CAPTURE(y_mm);
    Order order = order_of(y_mm, ",S 2,T 10");
    order.machine = machine;
    Shop shop(order);
    CHECK(!compensate(shop.job(), false).failure);
  }
}
