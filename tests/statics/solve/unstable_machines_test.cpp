/// Random machines up to buckling and beyond, some with springs of 1e9 to 1e13 N/m: what the module calls
/// unstable, and what not, against a judge that shares no code with it.
#include <fmt/format.h>

#include "statics/support/independent_judge.hpp"
#include "statics/support/laws_support.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

/// Between 10^low and 10^high.
double power(Random& random, double low, double high) {
  return std::pow(10, (low + high) / 2 + (high - low) / 2 * random.number());
}

double rigid_or_not(Random& random) {
  return random.number() > 0 ? power(random, 9, 13) : power(random, 6, 8);
}

/// Two halves with a weak kink between them, pinned, beside a guide.
std::string random_strut(Random& random) {
  const double first = 300 + 200 * random.number(), second = 300 + 200 * random.number();
  return fmt::format(R"(controlled = ["x"]
[home]
xyz_mm = [{0}, 0, 0]
[springs.mid]
stiffness_diag_si = [{1}, {1}, {1}, 1e6, {2}, 1e6]
[springs.guide]
stiffness_diag_si = [{3}, {3}, {3}, 1e7, 1e7, 1e7]
[[chain]]
name = "strut"
elements = [ {{ actuator = "prismatic", axis = "x" }}, {{ passive = "revolute", axis = "y" }},
  {{ rigid = {{ xyz_mm = [{4}, 0, 0] }} }}, {{ spring = "mid" }}, {{ rigid = {{ xyz_mm = [{5}, 0, 0] }} }},
  {{ passive = "revolute", axis = "y" }} ]
[[chain]]
name = "guide"
elements = [ {{ rigid = {{ xyz_mm = [{0}, 0, 0] }} }}, {{ passive = "prismatic", axis = "x" }}, {{ spring = "guide" }} ])",
                     first + second, rigid_or_not(random), power(random, 1.5, 3), rigid_or_not(random), first,
                     second);
}

/// Legs from a circle to the platform, each two hinges and a spring that is soft to some turns.
std::string random_parallel(Random& random) {
  const double height = 500 + 200 * random.number();
  std::string text = fmt::format("controlled = []\n[home]\nxyz_mm = [0, 0, {}]\n", height);
  const int legs = random.number() > 0 ? 3 : 2;
  std::string chains;
  for (int i = 0; i < legs; ++i) {
    const double angle = 2 * 3.14159265358979 * i / legs, x = 300 * std::cos(angle),
                 y = 300 * std::sin(angle);
    text += fmt::format("[springs.s{0}]\nstiffness_diag_si = [{1}, {1}, {2}, {3}, {4}, {5}]\n", i,
                        power(random, 5, 7), rigid_or_not(random), power(random, 2, 4), power(random, 2, 4),
                        power(random, 2, 4));
    chains += fmt::format(
        "[[chain]]\nname = \"leg{0}\"\nelements = [ {{ rigid = {{ xyz_mm = [{1}, {2}, 0] }} }}, {{ error = "
        "\"e\" }}, "
        "{{ passive = \"revolute\", axis = \"x\" }}, {{ rigid = {{ xyz_mm = [{3}, {4}, {5}] }} }}, {{ spring "
        "= \"s{0}\" }}, "
        "{{ passive = \"revolute\", axis = \"y\", stiffness_Nm_per_rad = {6}, preload_deg = {7} }} ]\n"
        "errors.e = {{ rpy_deg = [{8}, {9}, 0] }}\n",
        i, x, y, -x, -y, height, power(random, 1, 3), random.number(), 0.1 * random.number(),
        0.1 * random.number());
  }
  return text + chains;
}

/// An upright arm of springs and an elastic joint.
std::string random_arm(Random& random) {
  return fmt::format(R"(controlled = ["z"]
[springs.a]
stiffness_diag_si = [{0}, {0}, {0}, {1}, {1}, 1e5]
preload_si = [0, 0, 0, {2}, 0, 0]
[springs.b]
stiffness_diag_si = [{3}, {3}, {3}, {4}, {4}, 1e5]
[[chain]]
name = "arm"
elements = [ {{ actuator = "prismatic", axis = "z" }}, {{ spring = "a" }}, {{ rigid = {{ xyz_mm = [0, 0, {5}] }} }},
  {{ compliance = "revolute", axis = "y", stiffness_Nm_per_rad = {6} }}, {{ rigid = {{ xyz_mm = [0, 0, {7}] }} }},
  {{ spring = "b" }}, {{ rigid = {{ xyz_mm = [10, 0, 100] }} }} ])",
                     rigid_or_not(random), power(random, 2, 4), 1e-3 * random.number(), rigid_or_not(random),
                     power(random, 2, 4), 300 + 100 * random.number(), power(random, 2, 4),
                     300 + 100 * random.number());
}

struct Verdicts {
  int stable = 0, unstable = 0, undecided = 0;
};

/// Follows the machine as the load grows, and asks both about every equilibrium up to the first unstable one.
void compare(const Model& model, const Vector3& direction, Verdicts& verdicts) {
  constexpr double band = 1e-6;
  StaticsWork work(model.mechanism);
  Configuration at = model.home;
  for (const double force : {100.0, 700.0, 2500.0, 10000.0}) {
    CAPTURE(force);
    Load load;
    load.F.head<3>() = force * direction;
    const Equilibrium e = refine_forward(model, at, load, {}, work);
    if (e.status != Status::converged && e.status != Status::unstable) {
      ++verdicts.undecided;
      return;
    }
    const auto least =
        static_cast<double>(independent::Judge(model, e.configuration, force * direction).least_eigenvalue());
    CAPTURE(least);
    if (std::abs(least) > band) CHECK((e.status == Status::unstable) == (least < 0));
    (e.status == Status::unstable ? verdicts.unstable : verdicts.stable)++;
    if (e.status == Status::unstable) return;
    at = e.configuration;
  }
}

}  // namespace

TEST_CASE("200 random machines are stable and unstable where an independent judge finds them so" *
          doctest::test_suite("long")) {
  Verdicts verdicts;
  for (unsigned seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    Random random(9000 + seed);
    const int kind = static_cast<int>(seed % 3);
    const std::string text = kind == 0   ? random_strut(random)
                             : kind == 1 ? random_parallel(random)
                                         : random_arm(random);
    CAPTURE(text);
    const Model model = model_of_text(text);
    REQUIRE(model.home_status == Status::converged);
    Vector3 direction =
        kind == 0 ? Vector3(-1, 0, 0) : Vector3(0.01 * random.number(), 0.01 * random.number(), -1);
    compare(model, direction.normalized(), verdicts);
  }
  CHECK(verdicts.stable > 200);
  CHECK(verdicts.unstable > 60);
  CHECK(verdicts.undecided < 100);
}
