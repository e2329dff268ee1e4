// Moves that turn the tool of a six-axis machine much and move its tip little or not at all, under forces
// that change along them.
#include <fmt/format.h>

#include "compensation/support/shop.hpp"
#include "counterflex/forces/forces.hpp"
#include "counterflex/program/kept_words.hpp"

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

/// One row of a force for each line from 3 on; "linear" or "step".
ForceSource by_line(const std::string& interpolation, double blend) {
  constexpr double rows[][6] = {
      {-64, -394, -34, 11, -8, -18},    {-295, 70, 385, -7, 4, -6},  {-58, 227, -322, -19, -5, 0},
      {-21, -296, -183, 5, 4, -12},     {-55, 42, -166, -4, -3, -4}, {3, -231, -169, 11, 8, 11},
      {100, -218, -365, -10, -13, -14}, {243, -100, 252, 9, 1, 5},   {-298, -89, -167, 6, 3, 15}};
  std::string text =
      fmt::format("# frame = machine\n# sense = on_tool\n# interpolation = {}\n", interpolation) +
      "line, fx_N, fy_N, fz_N, mx_Nm, my_Nm, mz_Nm\n";
  int line = 3;
  for (const auto& F : rows)
    text += fmt::format("{}, {}, {}, {}, {}, {}, {}\n", line++, F[0], F[1], F[2], F[3], F[4], F[5]);
  ForceSource source;
  source.rules = read_force_csv(text, "forces.csv");
  source.blend = blend;
  return source;
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

/// Blocks that only turn the tool, by 0.006 to 17 degrees, between lines.
constexpr char in_place[] =
    "G21 G90 G17 G94\nG0 X0 Y0 Z20 A0 B0 C0\nG1 Z0 F300\nG1 A-0.678 B1.016 C0.927\nG1 A-13.6 B8.4 C2.3\n"
    "G1 X19.78 Y-2.18\nG1 A-13.62 B8.42 C2.28\nG1 X24.3 Y-2.5\nG1 A-13.617 B8.416 C2.286\n"
    "G1 X24.4 Y2.5\nG1 A-5 B4 C1.7\nG0 Z40\nM30\n";

}  // namespace

TEST_CASE("what turns much and goes a short way is verified with any tolerance") {
  for (const double tolerance : {2e-6, 5e-6, 20e-6}) {
    CAPTURE(tolerance);
    Order order = turning_order(short_ways, tolerance);
    order.force = constant_force((Vector6() << 120, -300, -80, 2, 5, -3).finished());
    check_right(order);
  }
}

TEST_CASE("blocks that only turn the tool are right under steps and ramps of the force") {
  for (const std::string interpolation : {"step", "linear"})
    for (const double blend : {0.0, 0.5e-3, 2e-3, 5e-3})
      for (const double tolerance : {2e-6, 20e-6}) {
        CAPTURE(interpolation);
        CAPTURE(blend);
        CAPTURE(tolerance);
        Order order = turning_order(in_place, tolerance);
        order.force = by_line(interpolation, blend);
        check_right(order);
      }
}

TEST_CASE("a program of few digits is verified with the digits of its words") {
  for (const char* text : {short_ways, in_place}) {
    CAPTURE(text);
    Order order = turning_order(text, 20e-6);
    order.decimals = 2;
    order.force = by_line("step", 0);
    Shop shop(order);
    const Program written = read_program(compensated(shop).text, "out.ngc", order.read);
    REQUIRE(refusal(shop, written) == "");
    shop.options.write.decimals = -1;
    CHECK(refusal(shop, written) == "");
  }
}

namespace {

/// `written` with the end of move `m` elsewhere (mm, deg about Y); it and the next one keep their time.
Program moved_aside(Program written, std::size_t m, double y_mm, double b_deg) {
  Move &move = written.moves[m], &next = written.moves[m + 1];
  move.end_mm.y() += y_mm;
  move.orientation->end[1] += b_deg;
  next.start_mm = move.end_mm;
  next.orientation->start = move.orientation->end;
  for (Move* piece : {&move, &next})
    if (const double way_mm = (piece->end_mm - piece->start_mm).norm(); way_mm > 0)
      piece->feed_mm_min = 300 * way_mm / turned_deg(*piece);
  return written;
}

}  // namespace

TEST_CASE("a point inside a turn is refused where the tip or the tilt is off the path") {
  Order order = turning_order(in_place, 5e-6);
  order.force = by_line("linear", 2e-3);
  const Shop shop(order);
  const Program written = read_program(compensated(shop).text, "out.ngc", order.read);
  std::size_t points = 0;
  for (std::size_t m = 1; m + 2 < written.moves.size(); ++m) {
    if (turned_deg(written.moves[m]) < 1 || turned_deg(written.moves[m + 1]) < 1) continue;
    ++points;
    CHECK(refusal(shop, moved_aside(written, m, 0, 0)) == "");
    CHECK(refusal(shop, moved_aside(written, m, 0.015, 0)).find("the tip misses") != std::string::npos);
    CHECK(refusal(shop, moved_aside(written, m, 0, 0.08)).starts_with("verification failed: "));
  }
  CHECK(points > 0);
}
