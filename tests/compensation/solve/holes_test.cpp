// Holes of cycles under the thrust of their drill.
#include "compensation/support/window_run.hpp"
#include "counterflex/forces/forces.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

ForceSource drilling() {
  ForceSource source;
  source.rules = read_force_toml(R"(format = "counterflex-forces 1"
[cutters.drill]
diameter_mm = 6
flutes = 2
point_angle_deg = 118
[materials.steel]
kc11_N_mm2 = 1675
mc = 0.24
[[section]]
cutter = "drill"
material = "steel"
)",
                                 "forces.toml");
  return source;
}

const std::string head = "G21 G90 G17 G54\nT1 M6\nS1500 M3\nF150\nG0 X0 Y0 Z30\n";
const std::string cycles =
    head + "G99 G81 X40 Y10 Z-12 R2\nX80 Y-35\nG98 G83 X15 Y60 Z-20 R3 Q4\nG80\nG0 Z30\nM30\n";
const std::string moves =
    head +
    "G0 X40 Y10\nZ2\nG1 Z-12\nG0 Z2\nX80 Y-35\nG1 Z-12\nG0 Z2\nX15 Y60\nZ3\nG1 Z-20\nG0 Z30\n"
    "G0 Z30\nM30\n";

Order order_for(const std::string& text, const ForceSource& force) {
  return {.machine = load_machine(small_mill),
          .text = text,
          .force = force,
          .tolerance = 2e-6,
          .X_MW = translation({0.01, 0.02, -0.03})};
}

/// What a prediction has at the bottoms of the three holes.
std::vector<Waypoint> bottoms(const Order& order) {
  WindowShop shop(order, 2);
  WindowRun run;
  WindowEvents events = events_for(run);
  std::vector<Waypoint> found;
  events.solved = [&](const Job& job, const std::vector<Waypoint>& some) {
    for (const Waypoint& w : some)
      if (is_place_of_cycle(job.program, w) || (w.cutting && w.fraction == 1)) found.push_back(w);
  };
  REQUIRE_FALSE(predict_windows(*shop.windows, 1, events));
  return found;
}

}  // namespace

TEST_CASE("holes of cycles deviate as those of the same program in feed moves") {
  ForceSource constant = constant_force(milling());
  for (const ForceSource& force : {drilling(), constant, ForceSource{}}) {
    const std::vector<Waypoint> drilled = bottoms(order_for(cycles, force)),
                                fed = bottoms(order_for(moves, force));
    REQUIRE(drilled.size() == 3);
    REQUIRE(fed.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK((drilled[i].p_MT - fed[i].p_MT).norm() < 1e-15);
      CHECK((drilled[i].wrench - fed[i].wrench).norm() < 1e-9);
      CHECK((drilled[i].after - fed[i].after).norm() < 1e-12);
      CHECK((drilled[i].causes->load - fed[i].causes->load).norm() < 1e-12);
    }
  }
  const Vector6 thrust = bottoms(order_for(cycles, drilling()))[0].wrench;
  CHECK(thrust.z() > 500);
  const Vector3 push = bottoms(order_for(cycles, drilling()))[0].causes->load.head<3>();
  CHECK(push.z() == doctest::Approx(1e-7 * thrust.z()).epsilon(1e-6));  // of the head
}

TEST_CASE("each hole of a block with repeats deviates as that of a block of its own") {
  const std::string begin = head + "G91 G98 G81 X20 Y-5 R-28 Z-14", end = "G90 G80\nG0 Z30\nM30\n";
  const std::string repeated = begin + " L4\n" + end, single = begin + "\nX20 Y-5\nX20 Y-5\nX20 Y-5\n" + end;
  const auto check_same = [](const std::vector<Waypoint>& all, const std::vector<Waypoint>& others) {
    REQUIRE(all.size() == 4);
    REQUIRE(others.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK((all[i].p_MT - others[i].p_MT).norm() < 1e-15);
      CHECK((all[i].wrench - others[i].wrench).norm() < 1e-9);
      CHECK((all[i].after - others[i].after).norm() < 1e-12);
    }
  };
  check_same(bottoms(order_for(repeated, drilling())), bottoms(order_for(single, drilling())));
  const auto corrected = [](const std::string& text) {
    const Program original = read_program(text, "part.ngc", {});
    std::vector<Waypoint> holes;
    for (const Waypoint& w : compensated(Shop(order_for(text, drilling()))).waypoints)
      if (is_place_of_cycle(original, w)) holes.push_back(w);
    return holes;
  };
  check_same(corrected(repeated), corrected(single));
}

TEST_CASE("the correction of a hole puts its bottom where it is wanted under the thrust") {
  const Compensation result = compensated(Shop(order_for(cycles, drilling())));
  std::size_t holes = 0;
  const Program original = read_program(cycles, "part.ngc", {});
  for (const Waypoint& w : result.waypoints) {
    if (!is_place_of_cycle(original, w)) continue;
    ++holes;
    CHECK(w.wrench.z() > 500);
    CHECK(w.after.head<3>().norm() < 2e-6);
    CHECK(w.before.z() > 40e-6);
    CHECK(w.correction.z() == doctest::Approx(-w.before.z()).epsilon(0.02));
  }
  CHECK(holes == 3);
}

TEST_CASE("klartext: the surface of a hole is corrected under the thrust, and verified so") {
  Order order = order_for(
      "BEGIN PGM A MM\nTOOL CALL 1 Z S1500\nCYCL DEF 200 DRILLING ~\nQ200=2 ~\nQ201=-12 ~\nQ206=150 "
      "~\nQ203=+0 "
      "~\nQ204=30\nL X+0 Y+0 Z+30 R0 FMAX\nL X+40 Y+10 R0 FMAX M99\nL X+80 Y-35 R0 FMAX M99\nL Z+100 R0 FMAX "
      "M30\nEND PGM A MM\n",
      drilling());
  order.read.dialect = "heidenhain";
  const double thrust = bottoms(order_for(cycles, drilling()))[0].wrench.z();
  const Program original = read_program(order.text, "part.ngc", order.read);
  std::size_t holes = 0;
  for (const Waypoint& w : compensated(Shop(order)).waypoints) {
    if (!is_place_of_cycle(original, w)) continue;
    ++holes;
    CHECK(w.wrench.z() == doctest::Approx(thrust));
    CHECK(w.after.head<3>().norm() < 2e-6);
  }
  CHECK(holes == 2);
}
