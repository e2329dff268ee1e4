// Programs at random, compensated in parts: merged, they are what one run makes of the whole.
#include <random>

#include "compensation/busy_program.hpp"
#include "compensation/parts.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// Pieces of work, one behind the other; all begin and end above the part, mostly.
class RandomJob {
 public:
  explicit RandomJob(unsigned seed) : random_(seed) {}

  std::string text(int operations) {
    text_ = "%\nG21 G90 G17 G54\nT1 M6\nS3000 M3\nG0 X0 Y0\nG43 H1 Z5\nG1 Z1 F500\n";
    for (int k = 0; k < operations; ++k) add_operation();
    return text_ + "G0 Z5\nM30\n%\n";
  }

 private:
  int pick(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  double place() { return 0.0001 * pick(300000); }

  void add_operation() {
    const int digits = 2 + pick(3);
    switch (pick(12)) {
      case 0:
        return add("G81 G98 X{:.2f} Y{:.2f} Z-2.5 R1 F100\nX{:.2f}\nY{:.2f}\nG80\n", place(), place(),
                   place(), place());
      case 1:
        return add("G41 D1 G1 X6 Y-4 F400\nX{:.3f}\nY3\nX6\nY-4\nG40 X5 Y-5\n", 10 + place());
      case 2:
        return add("G91\nG1 X0.5 Y{:.3f}\nX-0.25 Z-0.1\nY0.{}\nZ0.1\nG90\n", 0.01 * place(), pick(9));
      case 3:
        return add("G0 Z5\nT{} M6\nG0 X{:.1f} Y1\nG43 H1 Z{:.{}f}\nG1 Z1 F300\n", 1 + pick(3), place(),
                   2 + place() / 10, digits);
      case 4:
        return add("G0 Z5\n{}\nG0 X{:.1f} Y1 Z3\nG1 Z1\n", pick(2) == 0 ? "G54" : "G55", place());
      case 5:
        return add("G1 X10 Y10 F600\nG2 X10 Y10 Z{:.{}f} I{} J0\nG3 X14 Y10 R{:.2f}\n", 0.1 * place(), digits,
                   1 + pick(3), 2.0 + pick(4));
      case 6:
        return add("(FORCE FX={} FY=-5 FZ=-{})\n", pick(80), pick(40));
      case 7:
        return add("G0 X{:.2f} Y{:.2f}\n/ X{:.2f}\nX{:.2f} Y1 Z2\nG1 Z0.5\n", place(), place(), place(),
                   place());
      case 8:
        return add("G0 Z4\nG53 G0 Z0\nG0 X{:.1f} Y{:.1f}\nZ3\nG1 Z0.25\n", place(), place());
      case 9:
        return add("G1 Z{:.{}f} F350\n", -0.05 * place(), digits);
      default:
        return add_raster(digits);
    }
  }

  /// Without a word for Z.
  void add_raster(int digits) {
    text_ += "G1 F800\n";
    for (int row = 1 + pick(12); row > 0; --row)
      add("X{:.{}f}\nY{:.{}f}\n", place(), digits, place(), digits);
  }

  template <typename... Values>
  void add(fmt::format_string<Values...> format, Values&&... values) {
    text_ += fmt::format(format, std::forward<Values>(values)...);
  }

  std::mt19937 random_;
  std::string text_;
};

}  // namespace

TEST_CASE("whatever the program, its parts merged are the whole, and most of them are taken over" * doctest::test_suite("long")) {
  std::size_t windows = 0, compensated = 0, failed = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    CAPTURE(seed);
    Split split{on_mill(RandomJob(seed).text(60))};
    split.order.force = constant_force({15, -25, 10, 0, 0, 0}, seed % 4 == 0 ? 0 : 2e-3);
    split.least_moves = 5 + seed % 20;
    const Taken whole = take_over(split, {});
    const Folder folder;
    const Taken taken = take_over(split, record(split, 2 + seed % 4, folder));
    check_same_run(taken.run, whole.run);
    windows += whole.run.windows;
    compensated += taken.compensated;
    failed += whole.run.failure.has_value();
  }
  CHECK(windows > 200);
  CHECK(10 * compensated < windows);
  CHECK(failed < 3);
}
