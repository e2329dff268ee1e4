// Small programs at random: every run is refused, or leaves no more than the tolerance anywhere.
#include <fmt/format.h>

#include <random>

#include "compensation/support/judge.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// `size` is half the edge of the cube that the program stays in (mm).
std::string random_program(std::mt19937& random, double size) {
  const auto pick = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  const auto coordinate = [&] { return size * (2.0 * pick(100001) / 100000 - 1); };
  const int decimals = 1 + pick(4);
  std::string text = "G21 G90\n";
  if (pick(3) == 0) text += fmt::format("G0 Z{:.{}f}\n", coordinate(), decimals);
  text += fmt::format("G0 X{:.{}f} Y{:.{}f} Z{:.{}f}\nF500\n", coordinate(), decimals, coordinate(), decimals,
                      coordinate(), decimals);
  for (int i = 0; i < 6; ++i) {
    const bool rapid = pick(4) == 0;
    std::string block = rapid ? "G0" : "G1";
    const int axes = 1 + pick(7);
    for (int a = 0; a < 3; ++a)
      if (axes & (1 << a)) block += fmt::format(" {}{:.{}f}", "XYZ"[a], coordinate(), decimals);
    if (pick(5) == 0)
      text += fmt::format("(FORCE FX={} FY={} FZ={})\n", pick(300), pick(200) - 100, -pick(100));
    if (pick(8) == 0) text += "(FORCE OFF)\n";
    text += block + (!rapid && pick(4) == 0 ? " M8" : "") + "\n";
    if (pick(6) == 0) text += block + "\n";
  }
  return text + "M30\n";
}

}  // namespace

TEST_CASE("for any program, a run is refused or leaves no more than the tolerance anywhere" *
          doctest::test_suite("long")) {
  std::mt19937 random(20260401);
  int done = 0;
  for (int i = 0; i < 30; ++i) {
    const bool on_mill = i % 2 == 1;
    Order order{.machine = load_machine(on_mill ? mill : orthoglide_b),
                .text = random_program(random, on_mill ? 80 : 60)};
    if (on_mill) order.X_MW.p = Vector3(150, 110, -240) * mm;
    order.force.blend = i % 3 == 0 ? 0 : 2e-3;
    order.tolerance = i % 5 == 0 ? 20e-6 : 5e-6;
    CAPTURE(order.text);
    CAPTURE(order.force.blend);
    const Shop shop(order);
    const Compensation result = shop.run();
    if (result.failure) {
      CHECK(result.failure->line > 0);
      MESSAGE(result.failure->line << ": " << result.failure->what << "\n" << order.text);
      continue;
    }
    ++done;
    const Miss miss = dense_miss(shop, result, 15);
    CAPTURE(miss.line);
    CAPTURE(miss.u);
    CHECK(miss.size <= order.tolerance);
    const auto failure = verify(shop.job(), read_program(result.text, "c", {}), false).failure;
    CHECK(!failure);
    if (failure) MESSAGE("verify " << failure->corrected_line << ": " << failure->what);
  }
  CHECK(done >= 25);
}
