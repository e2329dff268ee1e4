// What verify refuses besides deviations: moves that nobody would judge, and other text that differs.
#include <utility>

#include "shop.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const std::string text = "G21 G90 G54\nG0 X0 Y0 Z5\nG1 Z0 F100\nX10\nM5\nM30\n";

/// The exit, line and words with which `changed` is refused as the corrected form of `text`.
std::string refusal(const std::string& changed) {
  const Shop shop({.machine = load_machine(orthoglide_perfect), .text = text});
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
  std::string changed = text;
  return changed.replace(changed.find(what), what.size(), by);
}

}  // namespace

TEST_CASE("a program is its own corrected form where nothing has to be corrected") {
  CHECK(refusal(text).empty());
  CHECK(refusal("(COUNTERFLEX 1 VERSION 0.1.0)\n" + text).empty());
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
