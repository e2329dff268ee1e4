// Judging a corrected program by its text alone.
#include "compensation/support/judge.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const char* const two_feeds =
    "G21 G90\nN10 G0 X-60. Y-60. Z-60.\nN20 G1 Y60. F600\nX40. Z-40.\nG0 Z20.\nG0 X0.\nG1 Z10.\nX30.\nX30. "
    "Y61.\nM30\n";

double largest_after(const std::vector<Waypoint>& waypoints, int line) {
  double largest = 0;
  for (const Waypoint& w : waypoints)
    if (w.line == line) largest = std::max(largest, w.after.head<3>().norm());
  return largest;
}

}  // namespace

TEST_CASE("a corrected program read again deviates as its compensation states") {
  for (const double blend : {2e-3, 0.0}) {
    CAPTURE(blend);
    const Shop shop({.machine = load_machine(orthoglide_b),
                     .text = two_feeds,
                     .force = constant_force(milling(), blend)});
    const Compensation result = compensated(shop);
    const Compensation run = judged(shop, result.text);
    CHECK(!run.failure);
    if (run.failure) MESSAGE(run.failure->line << ": " << run.failure->what);
    for (int line = 2; line <= 9; ++line) {
      CAPTURE(line);
      CHECK(largest_after(run.waypoints, line) == largest_after(result.waypoints, line));
    }
  }
}

TEST_CASE("steps of the force inside a move survive the judgement of the text") {
  const Shop shop({.machine = load_machine(orthoglide_b),
                   .text = "G21 G90\nG0 X-60. Y-60. Z-60.\nG1 Y60. F600\nM30\n",
                   .force = step_profile("0, 100, 0, 0\n50, 140, 0, 0\n90, 0, 200, 0\n", 0)});
  const Compensation run = judged(shop, compensated(shop).text);
  CHECK(!run.failure);
  if (run.failure) MESSAGE(run.failure->what);
}

TEST_CASE("blocks that act at their beginning are distinguished from each other and from their pieces") {
  for (const std::string cuts : {"G1 X40. M8\nG1 Y40. M8\n", "G1 X40.\nG1 Y40. M8\nG1 X-40. M8\n",
                                 "G1 Z40. M8\nG1 Z40.\nG1 Z-30. M8\nG1 Y40. Z16.\n"}) {
    CAPTURE(cuts);
    const Shop shop({.machine = load_machine(orthoglide_b),
                     .text = "G21 G90\nG0 X-60. Y-60. Z-60.\nF500\n" + cuts + "M30\n",
                     .force = constant_force(milling())});
    CHECK(!judged(shop, compensated(shop).text).failure);
  }
}

TEST_CASE("one coordinate that is changed by some hundredths is found, with its line" *
          doctest::test_suite("long")) {
  const Shop shop(
      {.machine = load_machine(orthoglide_b), .text = two_feeds, .force = constant_force(milling())});
  const Compensation result = compensated(shop);
  const Program corrected = read_program(result.text, "corrected.ngc", {});
  for (std::size_t m = 0; m < corrected.moves.size(); ++m)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto& word = corrected.moves[m].words[axis];
      if (!word) continue;
      // Along the path an inserted point may be elsewhere: the tip stays on the path.
      const Vector3 step = corrected.moves[m].end_mm - corrected.moves[m].start_mm;
      if (std::abs(step[static_cast<Eigen::Index>(axis)]) > 0.9 * step.norm()) continue;
      CAPTURE(corrected.moves[m].line);
      CAPTURE(axis);
      const double value = corrected.moves[m].end_mm[static_cast<Eigen::Index>(axis)] + 0.05;
      const std::string text =
          replaced(result.text.substr(word->number.begin),
                   result.text.substr(word->number.begin, word->number.end - word->number.begin),
                   std::to_string(value).substr(0, std::to_string(value).find('.') + 4));
      const auto failure = judged(shop, result.text.substr(0, word->number.begin) + text).failure;
      REQUIRE(failure);
      CHECK(failure->kind == ErrorKind::not_compensated);
      CHECK(failure->line >= 2);
      CHECK(failure->line <= 9);
    }
}

TEST_CASE("a changed end is found in its own move") {
  const Shop shop(
      {.machine = load_machine(orthoglide_b), .text = two_feeds, .force = constant_force(milling())});
  const Compensation result = compensated(shop);
  const Move changed = read_program(result.text, "corrected.ngc", {}).moves.back();
  REQUIRE(changed.words[1]);
  std::string text = result.text;
  text.replace(changed.words[1]->number.begin, changed.words[1]->number.end - changed.words[1]->number.begin,
               "61.900");
  const auto failure = judged(shop, text).failure;
  REQUIRE(failure);
  CHECK(failure->line == 9);
  CHECK(failure->corrected_line == changed.line);
}

TEST_CASE("a program with a move missing has no counterpart for it") {
  const Shop shop(
      {.machine = load_machine(orthoglide_b), .text = two_feeds, .force = constant_force(milling())});
  std::vector<std::string> lines = lines_of(compensated(shop).text);
  for (const std::string start : {"N20", "G0 Z", "N10"}) {
    CAPTURE(start);
    std::string text;
    for (const std::string& line : lines)
      if (!line.starts_with(start)) text += line + "\n";
    const auto failure = judged(shop, text).failure;
    REQUIRE(failure);
    CHECK(failure->corrected_line > 0);
  }
}

TEST_CASE("the original itself misses its path by the deviation before") {
  const Shop shop(
      {.machine = load_machine(orthoglide_b), .text = two_feeds, .force = constant_force(milling())});
  const Compensation run = judged(shop, two_feeds);
  REQUIRE(!run.waypoints.empty());
  for (const Waypoint& w : run.waypoints) {
    if (w.between) continue;
    CHECK((w.after - w.before).norm() < 1e-9);
  }
  CHECK(tolerance_failure(shop.job(), run.waypoints));
}
