/// Cold starts all over the workspaces of the reference machines: errors on, loaded, every pose from home.
#include "reference_runs.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

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

void check_grid(const std::string& name, const Grid& grid, const Vector6& wrench) {
  CAPTURE(name);
  Bench bench(reference_machine(name));
  REQUIRE(grid.size() >= 200);
  for (int i = 0; i < grid.size(); ++i) {
    const Pose X_MT = grid.at(i);
    CAPTURE(X_MT.p.transpose());
    CAPTURE(X_MT.R);
    const Configuration nominal = bench.at(X_MT);
    const Equilibrium forward = solve_forward(bench.model, nominal, {wrench}, all, bench.work);
    CHECK(to_string(forward.status) == "converged");
    const Equilibrium target = solve_target(bench.model, nominal, X_MT, {wrench}, all, bench.work);
    CHECK(to_string(target.status) == "converged");
    const Vector6 left = bench.deviation(target.configuration, X_MT);
    for (Component component : bench.model.mechanism.controlled)
      CHECK(std::abs(left[static_cast<int>(component)]) < 1e-11);
  }
}

const Vector6 milling_wrench = (Vector6() << 215, -10, -25, 1, 21.5, 0).finished();
const Vector6 hard_cut = (Vector6() << 900, -700, -1500, 20, -15, 25).finished();

}  // namespace

TEST_CASE("the Orthoglide converges from a cold start in all of its cube of 200 mm") {
  const Grid cube{{-73.65, -73.65, -73.65}, {126.35, 126.35, 126.35}, {6, 6, 6}, {0, 0, 0}, {0, 0, 0}};
  for (const char* name : {"orthoglide_case_a", "orthoglide_case_b"}) check_grid(name, cube, milling_wrench);
}

TEST_CASE(
    "the 6R robot converges from a cold start in a block before it, tool down and leaning by up to 20 "
    "degrees") {
  const Grid block{{1400, -600, 400}, {2100, 600, 1000}, {6, 7, 5}, {0, 90, 0}, {10, 20, 30}};
  for (const char* name : {"serial6r_joints", "serial6r_link6"}) check_grid(name, block, hard_cut);
}

TEST_CASE("the hexapod converges from a cold start in its workspace, leaning by up to 15 degrees") {
  const Grid block{{-150, -150, 780}, {150, 150, 950}, {6, 6, 6}, {0, 0, 0}, {12, 15, 15}};
  for (const char* name : {"hexapod_free_joints", "hexapod_joint_springs"}) check_grid(name, block, hard_cut);
}
