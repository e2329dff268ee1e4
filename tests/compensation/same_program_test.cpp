// What verify refuses besides deviations: moves that nobody would judge, and other text that differs.
#include <fmt/format.h>

#include <utility>

#include "gantry.hpp"
#include "shop.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const std::string spindle_stop = "G21 G90 G54\nG0 X0 Y0 Z5\nG1 Z0 F100\nX10\nM5\nM30\n";

/// The exit, line and words with which `changed` is refused as the corrected form of `spindle_stop`.
std::string refusal(const std::string& changed) {
  const Shop shop({.machine = load_machine(orthoglide_perfect), .text = spindle_stop});
  const Job job = shop.job();
  try {
    const Program program = read_program(changed, "changed.ngc", {});
    const ForwardRun run = solve_forward_along(job, match_programs(job, program), {});
    const auto failure = run.failure ? run.failure : tolerance_failure(job, run.waypoints);
    return failure ? "deviation" : "";
  } catch (const InputError& error) {
    CHECK(error.exit() == Exit::not_compensated);
    return error.what();
  }
}

std::string replaced(const std::string& what, const std::string& by) {
  std::string changed = spindle_stop;
  return changed.replace(changed.find(what), what.size(), by);
}

}  // namespace

TEST_CASE("a program is its own corrected form where nothing has to be corrected") {
  CHECK(refusal(spindle_stop).empty());
  CHECK(refusal("(COUNTERFLEX 1 VERSION 0.1.0)\n" + spindle_stop).empty());
}

TEST_CASE("moves that leave the path and come back are refused") {
  CHECK_FALSE(refusal(replaced("X10\n", "X10\nX10 Y50\nX10 Y0\n")).empty());
  CHECK_FALSE(refusal(replaced("X10\n", "X5 Y20\nX5 Y0\nX10\n")).empty());
  CHECK_FALSE(refusal(replaced("X10\n", "X5\nX4 Y0.5\nX10\n")).empty());
}

TEST_CASE("a line that holds no move has to stay as it is") {
  CHECK(
      refusal(replaced("G54", "G55")) ==
      "changed.ngc:1:1: error: differs from line 1 of the original, which is no move and must stay as it is");
  CHECK(
      refusal(replaced("M5\n", "")) ==
      "changed.ngc:5:1: error: differs from line 5 of the original, which is no move and must stay as it is");
  CHECK(refusal(replaced("M30\n", "M30\nM3\n")) == "changed.ngc:7:1: error: the original has no such line");
  CHECK(refusal(replaced("M30\n", "")) ==
        "changed.ngc:5:1: error: line 6 of the original is missing after this line");
}

TEST_CASE("words of a move that correction never changes have to stay") {
  CHECK(
      refusal(replaced("F100", "F1000")) ==
      "part.ngc:3:1: error: no move of the corrected program continues this one with the same words (motion, "
      "F, S, M) (verify)");
}

TEST_CASE("the surface of a Klartext cycle goes along with its holes, and nowhere else") {
  const auto program = [](const char* z, const char* surface) {
    return fmt::format(
        "0 BEGIN PGM A MM\n1 TOOL CALL 1 Z S1000\n2 L X+0 Y+0 Z{} R0 FMAX\n3 CYCL DEF 200 Q200=2 Q201=-5 "
        "Q203={} Q204=10\n"
        "4 L X+10 Y+5 FMAX M99\n5 L X+20 FMAX M99\n6 END PGM A MM\n",
        z, surface);
  };
  const Shop shop({.machine = rigid_gantry("0, 0, 0.01"), .text = program("+10", "+0")});
  const auto refused = [&](const std::string& changed) -> std::string {
    try {
      match_programs(shop.job(), read_program(changed, "changed.h", {}));
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  CHECK(refused(program("+9.990", "-0.010")).empty());
  CHECK(refused(program("+9.990", "-0.110")).find("surface of this hole's cycle") != std::string::npos);
  CHECK(refused(program("+9.990", "+0")).find("surface of this hole's cycle") != std::string::npos);
}
