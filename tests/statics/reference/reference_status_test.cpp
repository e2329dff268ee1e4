/// Every status is reached, and only where it should be.
#include <cmath>
#include <limits>

#include "statics/support/reference_runs.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// The machine of these chains and settings.
Machine machine_from(const std::string& text) {
  return read_machine("format = \"counterflex-machine 1\"\n" + text, "machine.toml");
}

// Two driven struts from both sides hold a point that is guided in the plane x, z; in line they do not hold
// it along z.
const std::string toggle = R"(
controlled = ["x", "z"]
home = { xyz_mm = [0, 0, 300] }

[templates.strut]
elements = [
  { rigid = { xyz_mm = ["$base", 0, 0] } },
  { passive = "revolute", axis = "y" },
  { actuator = "prismatic", axis = "x" },
  { compliance = "prismatic", axis = "x", stiffness_N_per_m = 1e6 },
  { rigid = { xyz_mm = ["$length", 0, 0] } },
  { passive = "revolute", axis = "y" },
]
[[chain]]
name = "left"
use = "strut"
values = { base = -1000, length = 1000 }
[[chain]]
name = "right"
use = "strut"
values = { base = 1000, length = -1000 }
[[chain]]
name = "guide"
elements = [ { passive = "prismatic", axis = "x" }, { passive = "prismatic", axis = "z" } ]
)";

// The toggle with its struts in line at home.
Machine standing_at_origin(Machine machine) {
  machine.home_X_MP = Pose{};
  return machine;
}

// One axis and a spring that is soft along z: `stiffness` N/m.
std::string soft_along_z(const std::string& stiffness) {
  return "controlled = [\"x\"]\n[springs.head]\nstiffness_diag_si = [1e6, 1e6, " + stiffness +
         ", 1e4, 1e4, 1e4]\n[[chain]]\nname = \"axis\"\nelements = [ { actuator = \"prismatic\", axis = "
         "\"x\" }, "
         "{ spring = \"head\" } ]\n";
}

}  // namespace

TEST_CASE("a target out of reach is unreachable") {
  const Bench orthoglide(reference_machine("orthoglide_case_b")), robot(reference_machine("serial6r_joints"));
  CHECK(follow(orthoglide.model, orthoglide.model.home, translation({0.6, 0.6, 0.6})).status ==
        Status::unreachable);
  Pose far = robot.tip(robot.model.home);
  far.p.x() += 4;
  CHECK(follow(robot.model, robot.model.home, far).status != Status::converged);
}

TEST_CASE("a home that does not close is unreachable, by as much as it misses") {
  Machine machine = reference_machine("parallel_bars_two_chains");
  machine.home_X_MP = translation({0.501, 0, 0});
  const Model model = prepare(machine);
  CHECK(model.home_status == Status::unreachable);
  CHECK(model.home_gap == doctest::Approx(std::sqrt(2.0) * 1e-3));
}

TEST_CASE(
    "the 6R robot is singular to its controller where joint 5 is straight, and is still held by its "
    "springs") {
  Bench bench(reference_machine("serial6r_joints"));
  Eigen::VectorXd rho = actuator_values(bench.model.mechanism, bench.model.home);
  rho[4] = 0;
  const NominalResult straight = nominal_forward(bench.model, bench.model.home, rho);
  REQUIRE(straight.status == Status::converged);
  CHECK(actuator_jacobian(bench.model, straight.configuration).condition > 1e6);
  CHECK(follow(bench.model, bench.model.home, bench.tip(straight.configuration)).status == Status::singular);
  const Load load{(Vector6() << -180, 240, 90, 5, -3, 8).finished()};
  const Equilibrium held = solve_forward(bench.model, straight.configuration, load, all, bench.work);
  CHECK(held.status == Status::converged);
}

TEST_CASE("struts in line do not hold their point: singular to the controller, and in statics, along z") {
  const Machine machine = machine_from(toggle);
  const Bench bench(machine);
  REQUIRE(bench.model.home_status == Status::converged);
  CHECK(follow(bench.model, bench.model.home, translation({0.05, 0, 0.25})).status == Status::converged);
  CHECK(follow(bench.model, bench.model.home, translation({0, 0, 0})).status == Status::singular);
  Bench in_line(standing_at_origin(machine));
  const Equilibrium solved = solve_forward(in_line.model, in_line.model.home, {}, all, in_line.work);
  REQUIRE(solved.status == Status::singular);
  CHECK(std::abs(solved.weakest[2]) > 0.99 * solved.weakest.norm());
}

TEST_CASE("struts in line under tension hold their point, under compression they are unstable") {
  Bench bench(standing_at_origin(machine_from(toggle)));
  for (double longer : {-1e-3, 1e-3}) {
    CAPTURE(longer);
    Configuration start = bench.model.home;
    const Eigen::Vector2d rho(longer, -longer);  // the right strut runs along -x
    set_actuator_values(bench.model.mechanism, rho, start);
    const Equilibrium solved = refine_forward(bench.model, start, {}, all, bench.work);
    CHECK(solved.status == (longer < 0 ? Status::converged : Status::unstable));
  }
}

TEST_CASE("a direction in which nothing holds the platform is singular, and is reported") {
  Bench bench(machine_from(soft_along_z("0")));
  const Load along_x{(Vector6() << 10, 0, 0, 0, 0, 0).finished()};
  const Equilibrium solved = solve_forward(bench.model, bench.model.home, along_x, all, bench.work);
  REQUIRE(solved.status == Status::singular);
  CHECK(std::abs(solved.weakest[2]) > 0.99 * solved.weakest.norm());
}

TEST_CASE(
    "a load on a direction in which nothing holds the platform finds no equilibrium: singular, as without "
    "it") {
  Bench bench(machine_from(soft_along_z("0")));
  const Load along_z{(Vector6() << 0, 0, 10, 0, 0, 0).finished()};
  CHECK(solve_forward(bench.model, bench.model.home, along_z, all, bench.work).status == Status::singular);
  CHECK(refine_forward(bench.model, bench.model.home, along_z, all, bench.work).status ==
        Status::not_converged);
}

TEST_CASE("a soft direction is not a singular one") {
  Bench bench(machine_from(soft_along_z("100")));
  const Load along_z{(Vector6() << 0, 0, 1, 0, 0, 0).finished()};
  const Equilibrium solved = solve_forward(bench.model, bench.model.home, along_z, all, bench.work);
  REQUIRE(solved.status == Status::converged);
  CHECK(bench.tip(solved.configuration).p.z() == doctest::Approx(0.01).epsilon(1e-9));
}

TEST_CASE("an actuator beyond its range is outside the travel, for any result of the statics") {
  const Bench bench(reference_machine("orthoglide_perfect"));
  const Mechanism& mechanism = bench.model.mechanism;
  CHECK(within_travel(mechanism, Eigen::Vector3d(0.26, -0.12, 0)));
  CHECK_FALSE(within_travel(mechanism, Eigen::Vector3d(0.2601, 0, 0)));
  CHECK_FALSE(within_travel(mechanism, Eigen::Vector3d(0, -0.1201, 0)));
  CHECK_FALSE(within_travel(mechanism, Eigen::Vector3d(0, 0, std::numeric_limits<double>::quiet_NaN())));
}

TEST_CASE("a truss pushed past its snap-through does not pass for converged on its own side") {
  Bench bench(machine_from(toggle));
  const Configuration nominal = follow(bench.model, bench.model.home, translation({0, 0, 0.1})).configuration;
  // Limit load of two struts of stiffness k, L0 = sqrt(1 + 0.01) m: 2 k L0 (1 - c^2)^(3/2), c^3 = 1 / L0.
  const double L0 = std::sqrt(1.01), c = std::cbrt(1 / L0), limit = 2 * 1e6 * L0 * std::pow(1 - c * c, 1.5);
  const auto pushed = [&](double part) {
    return solve_forward(bench.model, nominal, {(Vector6() << 0, 0, -part * limit, 0, 0, 0).finished()}, all,
                         bench.work);
  };
  const Equilibrium before = pushed(0.99), after = pushed(1.01);
  REQUIRE(before.status == Status::converged);
  CHECK(bench.tip(before.configuration).p.z() > 0.03);
  CHECK(after.status != Status::converged);
}

TEST_CASE("is_reached_by_load_alone is false beyond the snap-through of a lifted truss") {
  Bench bench(reference_machine("lifted_truss"));
  REQUIRE(bench.model.home_status == Status::converged);
  const auto pushed = [&](double N) { return Load{(Vector6() << 0, 0, -N, 0, 0, 0).finished()}; };
  const auto height = [&](const Load& load, bool& reached) {
    const Equilibrium found = solve_forward(bench.model, bench.model.home, load, all, bench.work);
    REQUIRE(found.status == Status::converged);
    reached = is_reached_by_load_alone(bench.model, bench.model.home, load, all, found, bench.work);
    return bench.tip(found.configuration).p.z();
  };
  for (const double N : {0.0, 10.0, 30.0, 100.0}) {
    CAPTURE(N);
    bool reached = false;
    const double z = height(pushed(N), reached);
    CHECK(reached == (z > 0));
    CHECK(reached == (N < 50));
  }
}
