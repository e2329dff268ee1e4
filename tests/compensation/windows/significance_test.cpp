// Corrections that are below their own uncertainty: what stays as programmed, and what verification accepts.
#include "counterflex/compensation/significance.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <random>

#include "compensation/support/gantry.hpp"
#include "compensation/support/window_run.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

constexpr double repeatability = 20 * um;
constexpr double square_error = 4e-4;  // rad

/// Its Y axis is not square to X: the deviation is `square_error` times y along -x. The band is twice the
/// repeatability: below y = 100 mm the deviation is not significant.
Order leaning(const std::string& text, double sigma = repeatability) {
  Order order{.machine = rigid_gantry("0, 0, 0", square_error), .text = text};
  order.machine.uncertainty.emplace().repeatability = sigma;
  return order;
}

/// What comes of the program with the option.
struct Faded {
  std::vector<bool> stay;
  WindowRun run;
};

WindowEvents no_events() {
  return {[](const Job&) {}, [](const Job&) {}, [](const Job&, const std::vector<Waypoint>&) {},
          [](const Job&, const Compensation&) {}};
}

std::vector<bool> staying(const Order& order, std::size_t least_moves) {
  WindowShop shop(order, least_moves);
  return targets_as_programmed(*shop.windows, order.threads, no_events());
}

Faded faded(const Order& order, std::size_t least_moves = 1000) {
  Faded result{staying(order, least_moves), {}};
  WindowShop shop(order, least_moves, {}, nullptr, &result.stay);
  shop.options.only_significant = true;
  result.run.failure =
      compensate_windows(*shop.windows, shop.options, TextReader(shop.reader), false, events_for(result.run));
  return result;
}

/// Why verification refuses `text`; empty: it accepts it.
std::string refusal(const Order& order, const std::string& text, bool only_significant = true) {
  const std::vector<bool> stay = staying(order, 1000);
  WindowShop shop(order, 1000, {}, nullptr, only_significant ? &stay : nullptr);
  shop.options.only_significant = only_significant;
  FileReader bytes = FileReader::of_bytes(text);
  ProgramReader corrected(bytes, "corrected.ngc", order.read);
  const auto failure = verify_windows(*shop.windows, 1, corrected, false, no_events());
  return failure ? failure->what : "";
}

std::size_t count(const std::vector<bool>& stay) {
  return static_cast<std::size_t>(std::count(stay.begin(), stay.end(), true));
}

/// A square, an arc and a drilled hole, `y` to 30 mm above it.
std::string part(double y) {
  return fmt::format(
      "G21 G90 G17 G54\nG0 X0 Y{0} Z5\nG1 Z0 F300\nG1 X40 F600\nG1 Y{1}\nG2 X50 Y{2} I10 J0\nG1 X0\nG1 Y{0}\n"
      "G0 Z5\nG98 G81 X10 Y{1} Z-3 R2 F200\nX20\nG80\nG0 X0 Y{0}\nM2\n",
      y, y + 20, y + 30);
}

/// Lines whose deviation is below the band, then above it, then below it.
const std::string up_and_down =
    "G21 G90 G17 G54\nG0 X0 Y0 Z0\nG1 X50 F600\nG1 Y60\nG1 X20\nG1 Y75\nG1 X0\nG1 Y180\nG1 X50\nG1 Y75\nG1 "
    "X0\nG1 Y20\nG1 X30\nM2\n";

}  // namespace

TEST_CASE("a program whose deviation is below its band everywhere keeps every byte") {
  const Order order = leaning(part(20));
  const Faded result = faded(order);
  REQUIRE_FALSE(result.run.failure);
  CHECK(result.run.text == order.text);
  CHECK(count(result.stay) == result.stay.size());
  CHECK(refusal(order, order.text).empty());
  CHECK_FALSE(refusal(order, order.text, false).empty());
}

TEST_CASE("a program whose deviation is above its band everywhere is as without the option") {
  const Order order = leaning(part(120));
  const WindowRun always = in_windows(order, 1000);
  const Faded result = faded(order);
  REQUIRE_FALSE(result.run.failure);
  CHECK(count(result.stay) == 0);
  CHECK(result.run.text == always.text);
  CHECK(always.text != order.text);
}

TEST_CASE("the correction fades out within moves that are below their bands from end to end") {
  const Order order = leaning(up_and_down);
  const Faded result = faded(order);
  REQUIRE_FALSE(result.run.failure);
  const std::vector<std::string> programmed = lines_of(order.text),
                                 always = lines_of(in_windows(order, 1000).text);
  const std::vector<std::string> lines = lines_of(result.run.text);
  const auto ends_with = [&](const std::string& line) {
    return std::count(lines.begin(), lines.end(), line);
  };
  for (const std::size_t line : {1, 2, 3, 4, 5}) {
    CAPTURE(line);
    CHECK(lines[line - 1] == programmed[line - 1]);
  }
  // Lines 8 to 10 are corrected as always: the target before them is that of line 7.
  for (const std::size_t line : {7, 8, 9, 10}) {
    CAPTURE(line);
    CHECK(ends_with(always[line - 1]) == 1);
    CHECK(always[line - 1] != programmed[line - 1]);
  }
  for (const std::size_t line : {11, 12, 13}) {
    CAPTURE(line);
    CHECK(ends_with(programmed[line - 1]) == 1);
  }
  CHECK(refusal(order, result.run.text).empty());
  for (const Waypoint& w : result.run.waypoints) {
    CAPTURE(w.line);
    CAPTURE(w.fraction);
    const double size = w.after.head<3>().norm();
    CHECK(size <= (w.insignificant ? 2 * repeatability : order.tolerance));
    if (w.insignificant && knows_before(w)) CHECK(size <= w.before.head<3>().norm() + 1e-6);
    if (w.line >= 8 && w.line <= 10) CHECK_FALSE(w.insignificant);
  }
}

TEST_CASE("a significant target that is left by hand is refused") {
  const Order order = leaning(up_and_down);
  const std::string text = faded(order).run.text;
  const std::string written = lines_of(text)[7];  // of line 8, perhaps behind points of line 7
  const std::vector<std::string> always = lines_of(in_windows(order, 1000).text);
  const std::string spoilt = replaced(text, always[7], "G1 Y180 X0.000");
  CHECK(refusal(order, text).empty());
  CHECK(refusal(order, spoilt).find("the tip misses the path by 0.04") != std::string::npos);
}

TEST_CASE("what stays does not depend on windows or threads") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> step(-40, 40);
  std::string text = "G21 G90 G17 G54\nG0 X0 Y100 Z0\nG1 F600\n";
  double x = 0, y = 100;
  for (int k = 0; k < 40; ++k) {
    x = std::clamp(x + step(random), -200.0, 200.0);
    y = std::clamp(y + step(random), 0.0, 200.0);
    text += fmt::format("{} X{:.3f} Y{:.3f}\n", k % 17 == 0 ? "G0" : "G1", x, y);
  }
  Order order = leaning(text + "M2\n");
  const Faded whole = faded(order);
  REQUIRE_FALSE(whole.run.failure);
  CHECK(count(whole.stay) > 4);
  CHECK(count(whole.stay) < whole.stay.size() - 4);
  CHECK(refusal(order, whole.run.text).empty());
  for (const std::size_t moves : {1, 4})
    for (const int threads : {1, 3}) {
      CAPTURE(moves);
      CAPTURE(threads);
      order.threads = threads;
      const Faded windows = faded(order, moves);
      CHECK(windows.run.windows > whole.run.windows);
      CHECK(windows.stay == whole.stay);
      CHECK(windows.run.text == whole.run.text);
    }
}

TEST_CASE("arcs fade the correction, and a part that was touched off stays as programmed") {
  std::string text = "G21 G90 G17 G54\nG0 X0 Y60 Z0\nG1 X10 F600\n";
  for (const int y : {70, 80, 90, 100, 110, 120, 110, 100, 90, 80, 70})
    text += fmt::format("G3 X10 Y{} R30\nG1 X20\nG2 X10 Y{} R30\n", y, y - 10);
  Order order = leaning(text + "M2\n");
  order.datum_shift = Vector3(1e-6, -2e-6, 3e-6);
  const Faded result = faded(order);
  REQUIRE_FALSE(result.run.failure);
  CHECK(count(result.stay) > 2);
  CHECK(count(result.stay) < result.stay.size());
  CHECK(refusal(order, result.run.text).empty());
  for (std::size_t line = 1; line <= 4; ++line)
    CHECK(lines_of(result.run.text)[line - 1] == lines_of(order.text)[line - 1]);
}

TEST_CASE("ends beside what keeps the correction of its start are corrected as always") {
  const std::string text =
      "G21 G90 G17 G54\nG0 X0 Y50 Z5\nG1 Z3 F300\nG1 X5\nG1 X0\nG1 Z0\nG41 D1 G1 X10 Y50\nG1 X40\nG1 Y70\nG1 "
      "X10\nG40 G1 X0\nG1 "
      "Y60\nG1 X5\nM2\n";
  const Order order = leaning(text);
  const Faded result = faded(order);
  REQUIRE_FALSE(result.run.failure);
  CHECK(result.stay.front());  // its neighbour is below, too
  CHECK(result.stay.back());
  CHECK(refusal(order, result.run.text).empty());
  for (std::size_t m = 4; m < 9; ++m) CHECK_FALSE(result.stay[m]);
}

namespace {

/// Lines and arcs in random directions under a force that steps at random places.
Order random_cuts(std::mt19937& random) {
  const auto number = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  std::string text = "G21 G90 G17\nG0 X0 Y0 Z0\nG1 F600\n", rows;
  double x = 0, y = 0, s = 0;
  for (int k = 0; k < 14; ++k) {
    const double x1 = std::clamp(x + number(-40, 40), -80.0, 80.0),
                 y1 = std::clamp(y + number(-40, 40), 0.0, 90.0);
    const double way = std::hypot(x1 - x, y1 - y);
    const char* kind = k % 4 == 3 ? "G2" : k % 7 == 5 ? "G0" : "G1";
    text +=
        fmt::format("{} X{:.3f} Y{:.3f}{}\n", kind, x1, y1, k % 4 == 3 ? fmt::format(" R{:.3f}", way) : "");
    x = x1, y = y1;
  }
  const double most = number(0, 60);
  for (; s < 500; s += number(1, 60))
    rows += fmt::format("{:.3f}, {:.2f}, {:.2f}, {:.2f}\n", s, number(-most, most), number(-most, most),
                        number(-most, most));
  Order order{.machine = load_machine(small_mill),
              .text = text + "M2\n",
              .force = step_profile(rows, random() % 2 == 0 ? 2e-3 : 0)};
  Uncertainty& uncertainty = order.machine.uncertainty.emplace();
  uncertainty.force = number(0, 0.6);
  uncertainty.repeatability = number(1, 12) * um;
  return order;
}

void check_random_cuts(unsigned seed, int programs) {
  std::mt19937 random(seed);
  std::size_t left = 0, all = 0;
  for (int k = 0; k < programs; ++k) {
    CAPTURE(k);
    const Order order = random_cuts(random);
    CAPTURE(order.text);
    if (in_windows(order, 1000).failure) continue;
    const Faded result = faded(order, 3);
    CHECK_MESSAGE(!result.run.failure, result.run.failure->line << ": " << result.run.failure->what);
    if (!result.run.failure) CHECK(refusal(order, result.run.text).empty());
    left += count(result.stay);
    all += result.stay.size();
  }
  CAPTURE(all);
  CHECK(left > all / 10);
  CHECK(left < all * 9 / 10);
}

}  // namespace

TEST_CASE("where a program can be corrected, it can be with the option, under forces that step") {
  check_random_cuts(1, 5);
}

TEST_SUITE("long") {
  TEST_CASE("many programs can be corrected with the option, under forces that step") {
    check_random_cuts(2, 300);
  }
}
