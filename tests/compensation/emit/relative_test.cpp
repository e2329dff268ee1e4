// G91: differences of what the text holds, so that rounding never adds up.
#include "compensation/support/gantry.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// A staircase of many small relative moves, in odd numbers.
std::string staircase(int steps) {
  std::string text = "G21 G90\nG0 X0. Y0. Z5.\nG1 Z0. F500\nG91\n";
  for (int i = 0; i < steps; ++i)
    text += fmt::format("X{:.4f} Y{:.4f}\n", 0.1003 + 0.0001 * (i % 7), (i % 5 - 2) * 0.0507);
  return text + "G90\nG0 Z20.\nM30\n";
}

ReadOptions tool_lengths() {
  ReadOptions options;
  options.tool_lengths_mm = {{1, 40.0}, {2, 45.0}};
  return options;
}

}  // namespace

TEST_CASE("a thousand relative moves on a machine out of square do not drift") {
  const std::string text = staircase(1000);
  const double angle = 1e-3;
  const Shop shop({.machine = rigid_gantry("0, 0, 0", angle), .text = text});
  const Compensation result = compensated(shop);
  const std::vector<Move> before = moves_in(text), after = moves_in(result.text);
  REQUIRE(before.size() == after.size());
  std::size_t changed = 0;
  for (std::size_t m = 0; m < before.size(); ++m) {
    CAPTURE(before[m].line);
    const Vector3& p = before[m].end_mm;
    const double y = p.y() / std::cos(angle);
    const Vector3 expected(p.x() + y * std::sin(angle), y, p.z());
    CHECK((after[m].end_mm - expected).cwiseAbs().maxCoeff() <= 0.5e-3 + 1e-9);
    changed += (after[m].end_mm - after[m].start_mm - p + before[m].start_mm).norm() > 1e-6;
  }
  CHECK(changed > 0);
}

TEST_CASE("relative moves carry a constant shift without a change") {
  const std::string text = staircase(20);
  const Compensation result = compensated(Shop({.machine = displaced_gantry(), .text = text}));
  const auto lines = lines_of(text), found = lines_of(result.text);
  REQUIRE(lines.size() == found.size());
  for (std::size_t i = 3; i < 24; ++i) CHECK(found[i] == lines[i]);
  CHECK((moves_in(result.text).back().end_mm - moves_in(text).back().end_mm - shift_mm).norm() < 1e-6);
}

TEST_CASE("relative arcs are corrected like others") {
  const std::string text =
      "G21 G90\nG0 X0. Y0. Z0.\nG91 G2 X40. Y0. I20. J0. F500\nG3 X20. Y20. I0. J20.\nG1 Y30.\nG90\nG0 "
      "Z20.\nM30\n";
  const Shop shop({.machine = rigid_gantry("0, 0, 0", -1e-3), .text = text});
  const Compensation result = compensated(shop);
  CHECK(dense_miss(shop, result, 60).size <= 5e-6);
  CHECK(result.counts.changed_words > 0);
}

TEST_CASE("a change of the tool's length moves the coordinates from which relative moves count") {
  const std::string text =
      "G21 G90\nT1 M6\nG43 H1\nG0 X0. Y0. Z5.\nG91\nG43 H2 Z-3.\nG1 Z-1. F300\nX10.\nG90\nG0 Z20.\nM30\n";
  Shop shop({.machine = displaced_gantry(), .text = text});
  shop.program = read_program(text, "part.ngc", tool_lengths());
  shop.path = build_toolpath(shop.program, one_frame(shop.program, {}));
  shop.forces.emplace(ForceSource{}, shop.program, shop.path,
                      std::vector<Matrix3>{tip(shop.model.mechanism, shop.model.home).R});
  Job job = shop.job();
  job.read = tool_lengths();
  const Compensation result = compensate(job, false);
  REQUIRE(!result.failure);
  const std::vector<std::string> lines = lines_of(result.text);
  CHECK(lines[5] == "G43 H2 Z-3.");
  CHECK(lines[6] == "G1 Z-1. F300");
  CHECK(lines[9] == "G0 Z19.875");
}
