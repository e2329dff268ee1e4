// Arcs, short blocks and jumps: verify accepts what compensate wrote, and nothing that differs from it.
#include <fmt/format.h>

#include "compensation/support/gantry.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const char* const rapid_and_plunge = "G21 G90 G17\nG0 X0 Y0 Z5\nG1 Z-1 F200\n";

/// What follows a plunge to the origin.
const char* const cut_lists[] = {
    "X20 F600\nG3 X30 Y10 I0 J10\nG1 Y30\nG2 X30 Y30 I10 J0\n",
    "G1 X-12.2 Y6.8\nG3 X-0.7 Y44.9 I-8.666 J23.401 M8\nG1 X17.6 Y54.4\nG2 X3.7 Y41.4 Z-2.9 R13.5\n",
    "G90.1 G2 X0 Y0 I17.2 J-7.6 M8\nG2 X0 Y0 I10.9 J-32.8\nG3 X-28.209 Y-15.33 I-5.5 J-23.5\n",
    "G2 X0 Y0 I1.84 J6.39 M8\nG1 X0.14\nG1 X4.4 Y1.1 M8\nG2 X2.2 Y5.1 I-1.1 J2 M8\nG1 X7.9 Y3.7\n",
    "G1 X0.02\nX0.05\nX0.05 Y0.03\nG3 X0.05 Y0.03 I-0.4 J0\nG1 X0.02 Y0.01\nX3\nX3.01\nX2.99\nX60\n",
    "G3 X0 Y20 Z-4 I0 J10 P3\nG1 X30\nG0 Z10 M9\nG0 X0\nG1 Z-1\nX44\n",
};

Shop shop_for(const std::string& cut, const ForceSource& source, double tolerance) {
  Order order{.machine = load_machine(small_mill), .text = rapid_and_plunge + cut + "M30\n", .force = source};
  order.tolerance = tolerance;
  return Shop(order);
}

ForceSource profile(const std::string& frame, double step_mm, double blend) {
  ForceSource source;
  source.rules = read_force_csv(
      fmt::format("# frame = {}\n# sense = on_tool\ns_mm, fx_N, fy_N, fz_N\n0, -80, 30, 10\n{}, -150, 0, "
                  "10\n{}, 60, 90, 30\n{}, 60, -90, 20\n",
                  frame, step_mm, step_mm + 0.4, 2 * step_mm + 7),
      "forces.csv");
  source.blend = blend;
  return source;
}

/// `text` without its line `number`, counted from 0, or with another in its place.
std::string without_line(const std::string& text, std::size_t number, const std::string& other = "") {
  std::string changed;
  const std::vector<std::string> lines = lines_of(text);
  for (std::size_t i = 0; i + 1 < lines.size(); ++i)
    if (i != number || !other.empty()) changed += (i == number ? other : lines[i]) + "\n";
  return changed;
}

Shop circle_shop(const std::string& machine, double blend) {
  return Shop({.machine = load_machine(machine),
               .text = "G21 G90 G17\nG0 X30. Y0. Z0.\nG3 X30. Y0. Z-4. I-30. J0. F600\nM30\n",
               .force = step_profile("0, 0, 0, 0\n0.2, 180, -90, -25\n90, 0, 100, 0\n", blend)});
}

/// Every block for which `change` has another text, or of many every few, is refused with that in its place.
template <typename Change>
void check_refused(const Shop& shop, const Change& change) {
  const std::string text = compensated(shop).text;
  REQUIRE(refusal_of(shop, text).empty());
  const std::vector<std::string> lines = lines_of(text);
  std::size_t changed = 0;
  for (std::size_t i = 2; i + 2 < lines.size();
       i += std::max<std::size_t>(1, lines.size() / 12)) {  // up to M30
    const std::optional<std::string> other = change(lines[i]);
    if (!other) continue;
    CAPTURE(lines[i]);
    CHECK_FALSE(refusal_of(shop, without_line(text, i, *other)).empty());
    ++changed;
  }
  CHECK(changed > 1);
}

// Why a program that was compensated on the small mill, with jumps of the force, is refused; empty if not.
std::string refusal_as_written(const std::string& text, const Vector3& F) {
  Order order{.machine = load_machine(small_mill), .text = text};
  order.force = constant_force((Vector6() << F, Vector3::Zero()).finished());
  order.force.blend = 0;
  order.tolerance = 5e-6;
  const Shop shop(order);
  const Compensation written = compensated(shop);
  REQUIRE(!written.failure);
  return refusal_of(shop, written.text);
}

}  // namespace

TEST_CASE(
    "verify accepts arcs, circles, helices and short blocks with ramps and jumps as they were written") {
  for (const char* cut : cut_lists)
    for (const std::string frame : {"feed", "machine"})
      for (const double blend : {0.0, 0.5e-3, 2e-3})
        for (const double step_mm : {0.3, 6.02, 20.0}) {
          CAPTURE(cut);
          CAPTURE(frame);
          CAPTURE(blend);
          CAPTURE(step_mm);
          const Shop shop = shop_for(cut, profile(frame, step_mm, blend), 5e-6);
          CHECK(refusal_of(shop, compensated(shop).text) == "");
        }
}

TEST_CASE("steps of the force are found in a program of fewer digits than the job has") {
  for (const char* cut : {"X20 F600\nY20\nX0\n", "G3 X20 Y20 I0 J20 F600\nG1 X0\n"}) {
    CAPTURE(cut);
    Order order{.machine = load_machine(small_mill), .text = std::string(rapid_and_plunge) + cut + "M30\n"};
    order.force = profile("machine", 6.02, 0);
    order.tolerance = 20e-6;
    order.decimals = 2;
    Shop shop(order);
    const std::string text = compensated(shop).text;
    REQUIRE(refusal_of(shop, text) == "");
    shop.options.write.decimals = -1;
    CHECK(refusal_of(shop, text) == "");
  }
}

TEST_CASE("a block that goes nowhere is found behind a short block and the jump in front of it") {
  CHECK(refusal_as_written(
            "G21 G90 G17\nG0 X120. Y20. Z5.\nG1 Z0. F600\nX121.906\nG0 Z5.\nG1 Z0.\nG0 X122.906\n"
            "G1 X122.908\nG1 X122.908\nY21.999\nY22.999\nX122.907\nG0 Z20.\nM30\n",
            {-146, -114, 2}) == "");
}

TEST_CASE("a jump that the digits of the text do not show takes no move") {
  CHECK(refusal_as_written("G21 G90 G17\nG0 X20. Y20. Z5.\nG1 Z0. F600\nX20.003\nG0 X21.003\nG1 X21.004\n"
                           "X21.003\nX24.003\nX23.503\nG0 Z5.\nM30\n",
                           {8, 9, -5}) == "");
}

TEST_CASE("verify accepts ramps so short that the tip runs ahead of its path in them") {
  const std::string groove = "G21 G90\nG0 X-73.65 Y-73.65 Z-63.65\nG1 Z-73.65 F300\nY126.35\nZ-63.65\nM30\n";
  for (const double blend : {0.01e-3, 0.1e-3, 0.5e-3}) {
    CAPTURE(blend);
    const Shop shop({.machine = load_machine(orthoglide_b),
                     .text = groove,
                     .force = step_profile("0, 0, 0, 0\n10, 215, -10, -25\n210, 0, 0, 0\n", blend)});
    const Compensation written = compensated(shop);
    REQUIRE(!written.failure);
    CHECK(refusal_of(shop, written.text) == "");
  }
}

TEST_CASE("a chord in the place of an arc is refused where it misses the tolerance") {
  for (const double blend : {0.0, 2e-3})
    check_refused(circle_shop(small_mill, blend), [](const std::string& line) -> std::optional<std::string> {
      if (!line.starts_with("G3")) return std::nullopt;
      const std::size_t words = line.find(" I");
      if (line.find("Z-0.0") != std::string::npos) return std::nullopt;  // the ramp: hardly longer than wide
      return "G1" + line.substr(2, words - 2) + " F600";
    });
}

TEST_CASE("an arc from which a piece is missing is refused") {
  check_refused(circle_shop(orthoglide_b, 2e-3), [](const std::string& line) -> std::optional<std::string> {
    if (!line.starts_with("G3")) return std::nullopt;
    return "";
  });
}

TEST_CASE("a jump of the correction that is left out, or made where the force does not step, is refused") {
  const Shop shop = circle_shop(small_mill, 0);
  check_refused(shop, [](const std::string& line) -> std::optional<std::string> {
    if (!line.starts_with("G1")) return std::nullopt;
    return "";
  });
  const std::string text = compensated(shop).text;
  const std::vector<std::string> lines = lines_of(text);
  for (std::size_t i = 2; lines[i] != "M30"; ++i) {
    CAPTURE(lines[i]);
    CHECK_FALSE(
        refusal_of(shop, without_line(text, i, lines[i] + "\nG91 G1 X0.03 Y-0.02 F600\nG90")).empty());
  }
}

TEST_CASE("an arc that makes another number of turns than the original is refused") {
  const std::string helix = "G21 G90 G17\nG0 X30. Y0. Z0.\nG3 X30. Y0. Z-3. I-30. J0. P3 F600\nM30\n";
  const Shop shop({.machine = displaced_gantry(), .text = helix});
  std::string text = compensated(shop).text;
  CHECK(refusal_of(shop, text) == "");
  CHECK_FALSE(refusal_of(shop, text.replace(text.find("P3"), 2, "P2")).empty());
}
