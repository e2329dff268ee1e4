/// Cold starts all over the workspaces of the reference and sample machines: errors on, loaded, every pose
/// solved from its nominal configuration, with nothing known of its neighbours.
#include "counterflex/machine/machine.hpp"
#include "statics/support/reference_runs.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// A pose that the nominal machine reaches must be solved where the condition of the unloaded, perfect
/// machine is below this. The Orthoglide has 4e4 at home, the others less.
constexpr double well_conditioned = 1e6;
constexpr int fewest_poses = 500;

/// Tip poses on a regular grid of `count` points an axis between `low` and `high` (mm); the orientation
/// (roll, pitch, yaw, deg) is `rpy` plus a share of `turn` that changes from point to point.
struct Grid {
  Vector3 low, high;
  Eigen::Vector3i count;
  Vector3 rpy, turn;

  int size() const { return count.prod(); }
  Pose at(int index) const {
    const Eigen::Vector3i i(index % count[0], index / count[0] % count[1], index / (count[0] * count[1]));
    Pose X;
    for (int axis = 0; axis < 3; ++axis)
      X.p[axis] = (low[axis] + (high[axis] - low[axis]) * i[axis] / (count[axis] - 1)) * mm;
    const Vector3 share(index % 5 / 2.0 - 1, index % 3 - 1.0, index % 7 / 3.0 - 1);
    X.R = from_rpy((rpy + share.cwiseProduct(turn)) * deg);
    return X;
  }
};

/// Solved, or excused by a badly conditioned machine.
bool is_solved(Bench& bench, const Equilibrium& result, const Configuration& nominal) {
  if (result.status == Status::converged) return true;
  const double condition = static_condition(bench.model, nominal, {}, {0, 0, 0, 0}, bench.work);
  CAPTURE(condition);
  CAPTURE(to_string(result.status));
  CHECK(condition >= well_conditioned);
  return false;
}

void check_grid(const Machine& machine, const Grid& grid, const Vector6& wrench) {
  CAPTURE(machine.name);
  Bench bench(machine);
  int solved = 0;
  for (int i = 0; i < grid.size(); ++i) {
    const Pose X_MT = grid.at(i);
    CAPTURE(X_MT.p.transpose());
    CAPTURE(X_MT.R);
    const NominalResult nominal = follow(bench.model, bench.model.home, X_MT);
    if (nominal.status != Status::converged) continue;
    const Equilibrium forward = solve_forward(bench.model, nominal.configuration, {wrench}, all, bench.work);
    const Equilibrium target =
        solve_target(bench.model, nominal.configuration, X_MT, {wrench}, all, bench.work);
    if (!is_solved(bench, forward, nominal.configuration) || !is_solved(bench, target, nominal.configuration))
      continue;
    ++solved;
    const Vector6 left = bench.deviation(target.configuration, X_MT);
    for (Component component : bench.model.mechanism.controlled)
      CHECK(std::abs(left[static_cast<int>(component)]) < 1e-11);
  }
  CHECK(solved >= fewest_poses);
}

Machine sample_file(const std::string& name) {
  return load_machine(COUNTERFLEX_SOURCE_DIR "/samples/" + name);
}

const Vector6 milling_wrench = (Vector6() << 215, -10, -25, 1, 21.5, 0).finished();
const Vector6 hard_cut = (Vector6() << 900, -700, -1500, 20, -15, 25).finished();

// Beyond the cube of 200 mm from -73.65 to 126.35 mm that it is made for.
const Grid orthoglide_block{{-95, -95, -95}, {150, 150, 150}, {8, 8, 8}, {0, 0, 0}, {0, 0, 0}};
const Grid mill_block{{1, 1, -438}, {399, 249, -142}, {8, 8, 8}, {0, 0, 0}, {0, 0, 0}};

}  // namespace

TEST_CASE("the Orthoglide of case A converges from a cold start in all of its workspace" *
          doctest::test_suite("long")) {
  check_grid(reference_machine("orthoglide_case_a"), orthoglide_block, milling_wrench);
}

TEST_CASE("the Orthoglide of case B converges from a cold start in all of its workspace" *
          doctest::test_suite("long")) {
  check_grid(reference_machine("orthoglide_case_b"), orthoglide_block, milling_wrench);
}

TEST_CASE("the Orthoglides of the samples converge from a cold start in all of their workspaces" *
          doctest::test_suite("long")) {
  for (const char* name : {"orthoglide-assembly/case_a.toml", "orthoglide-assembly/case_b.toml",
                           "orthoglide-groove/machine.toml"})
    check_grid(sample_file(name), orthoglide_block, milling_wrench);
}

TEST_CASE(
    "the 6R robot converges from a cold start in a block before it, tool down and leaning by up to 20 "
    "degrees" *
    doctest::test_suite("long")) {
  const Grid block{{1400, -600, 400}, {2100, 600, 1000}, {8, 9, 8}, {0, 90, 0}, {10, 20, 30}};
  for (const char* name : {"serial6r_joints", "serial6r_link6"})
    check_grid(reference_machine(name), block, hard_cut);
}

TEST_CASE("the robot with a spindle converges from a cold start under its weight, leaning too" *
          doctest::test_suite("long")) {
  const Grid block{{1300, -600, 300}, {1900, 600, 900}, {8, 9, 8}, {0, 0, 0}, {10, 20, 30}};
  check_grid(sample_file("robot-spindle/machine.toml"), block, hard_cut);
}

TEST_CASE("the hexapod converges from a cold start in its workspace, leaning by up to 15 degrees" *
          doctest::test_suite("long")) {
  const Grid block{{-200, -200, 750}, {200, 200, 1050}, {8, 8, 8}, {0, 0, 0}, {12, 15, 15}};
  for (const char* name : {"hexapod_free_joints", "hexapod_joint_springs"})
    check_grid(reference_machine(name), block, hard_cut);
}

TEST_CASE("the mill converges from a cold start in all of its travel, with a slender tool too" *
          doctest::test_suite("long")) {
  const Machine with_slender_tool = sample_file("mill3-slot/machine.toml");
  check_grid(sample_file("mill3/machine.toml"), mill_block, hard_cut);
  check_grid(with_tool(with_slender_tool, with_slender_tool.tools.at(3)), mill_block, hard_cut);
}
