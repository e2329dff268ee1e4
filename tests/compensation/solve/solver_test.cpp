/// Targets all over the workspaces of the machines, asked for in one batch, far from one another.
#include "compensation/solve/solver.hpp"

#include <doctest/doctest.h>

#include "counterflex/compensation/options.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "support/reference_data.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// Corners of a block of positions of the tip (mm, machine axes).
struct Block {
  Vector3 low, high;
};

constexpr int per_axis = 5, asked = per_axis * per_axis * per_axis;
constexpr int stride = 47;  // has no common divisor with 125: neighbours in a batch are far apart

Vector3 place(const Block& block, int i) {
  const int k = i * stride % asked;
  const Eigen::Array3d share(k % per_axis, k / per_axis % per_axis, k / per_axis / per_axis);
  return (block.low.array() + share / (per_axis - 1) * (block.high - block.low).array()) * mm;
}

/// A cut whose directions change from place to place.
Load cut(int i) {
  Load load;
  load.F << 215.0 * (i % 3 - 1), 60.0 * (i % 5 - 2), -25, 1, 21.5 * (i % 2), 0;
  return load;
}

/// Answers of a batch are, to the last bit, those of a solver for each request alone: one by one, and by the
/// kernel.
void check_order(const Machine& machine, const Block& block) {
  CAPTURE(machine.name);
  const Model model = prepare(machine);
  const Program program = read_program("G21 G90\nG0 X0 Y0 Z0\nG1 X1 F600\nM30\n", "made.ngc", {});
  const Toolpath path = build_toolpath(program, one_frame(program, {}));
  const PathForces forces({}, program, path, {tip(model.mechanism, model.home).R});
  const StartTables starts;
  for (const StartTables* tables : {static_cast<const StartTables*>(nullptr), &starts}) {
    CAPTURE(tables != nullptr);
    const Job job{.model = model, .program = program, .path = path, .forces = forces, .starts = tables};
    std::vector<TargetRequest> requests;
    for (int i = 0; i < asked; ++i) requests.push_back({&model, place(block, i), cut(i).F});
    std::vector<TargetAnswer> together(asked);
    PlaceSolver(job).targets(requests, together);
    std::vector<ForwardRequest> commands;
    for (int i = 0; i < asked; ++i)
      commands.push_back({&model, place(block, i), cut(i).F, i % 4 == 0 ? Stage{.errors = 0} : Stage{}});
    std::vector<ForwardAnswer> reached(asked);
    PlaceSolver(job).forwards(commands, reached);
    for (int i = 0; i < asked; ++i) {
      CAPTURE(requests[i].p_MT.transpose());
      CAPTURE(requests[i].F.transpose());
      TargetAnswer alone;
      PlaceSolver(job).targets({&requests[i], 1}, {&alone, 1});
      CHECK(to_string(together[i].status) == "converged");
      CHECK(to_string(alone.status) == "converged");
      CHECK(together[i].target == alone.target);
      ForwardAnswer reached_alone;
      PlaceSolver(job).forwards({&commands[i], 1}, {&reached_alone, 1});
      CHECK(to_string(reached_alone.status) == "converged");
      CHECK(reached[i].X_MT.p == reached_alone.X_MT.p);
      CHECK(reached[i].X_MT.R == reached_alone.X_MT.R);
      CHECK(reached[i].rho == reached_alone.rho);
    }
  }
}

}  // namespace

TEST_CASE("an answer for the Orthoglide does not depend on other requests") {
  const Block cube{{-73.65, -73.65, -73.65}, {126.35, 126.35, 126.35}};
  check_order(load_machine(reference_machine_file("orthoglide_case_a")), cube);
  check_order(load_machine(reference_machine_file("orthoglide_case_b")), cube);
}

TEST_CASE("an answer for the hexapod does not depend on other requests") {
  const Block block{{-120, -120, 780}, {120, 120, 940}};
  check_order(load_machine(reference_machine_file("hexapod_joint_springs")), block);
  check_order(load_machine(reference_machine_file("hexapod_free_joints")), block);
}

TEST_CASE("an answer for a serial machine does not depend on other requests") {
  check_order(load_machine(reference_machine_file("serial6r_link6")), {{1500, -300, 500}, {1900, 300, 900}});
  check_order(load_machine(COUNTERFLEX_SOURCE_DIR "/samples/mill3/machine.toml"),
              {{10, 10, -420}, {390, 240, -160}});
}

TEST_CASE("behind the first failure no answer is sought, and the answers before it are right") {
  const Model model = prepare(load_machine(reference_machine_file("orthoglide_case_b")));
  const StartTables starts;
  for (const StartTables* tables : {static_cast<const StartTables*>(nullptr), &starts}) {
    std::vector<TargetRequest> requests;
    for (const double x : {0.0, 0.01, 9.0, 0.02}) requests.push_back({&model, Vector3(x, 0, 0)});
    std::vector<TargetAnswer> answers(4), all(4);
    PlaceSolver(tables, false).targets(requests, answers);
    PlaceSolver(tables, false).targets(requests, all, StopAt::end);
    CHECK(answers[1].status == Status::converged);
    CHECK(answers[1].target == all[1].target);
    CHECK(to_string(answers[2].status) == "unreachable");
    CHECK(answers[3].status == Status::not_converged);
    CHECK(all[3].status == Status::converged);
  }
}

TEST_CASE("a straight way inside the workspace stays on one branch, a way out of it does not") {
  const Model model = prepare(load_machine(reference_machine_file("orthoglide_case_b")));
  const StartTables starts;
  for (const StartTables* tables : {static_cast<const StartTables*>(nullptr), &starts}) {
    PlaceSolver solver(tables, false);
    const auto at = [&](double x, double y, double z) { return TipPosition{&model, Vector3(x, y, z) * mm}; };
    CHECK(solver.join(at(-70, -70, -70), at(120, 100, 90)) == Status::converged);
    CHECK(solver.join(at(0, 0, 0), at(9000, 0, 0)) != Status::converged);
    CHECK(solver.join(at(9000, 0, 0), at(0, 0, 0)) != Status::converged);
  }
}

// The wrist centre of the robot is above and behind its tip; on the axis of the first joint that may turn
// freely.
TEST_CASE("a straight way through a singularity leaves the branch, though a way beside it does not") {
  const Model model = prepare(load_machine(reference_machine_file("serial6r_joints")));
  const StartTables starts;
  for (const StartTables* tables : {static_cast<const StartTables*>(nullptr), &starts}) {
    PlaceSolver solver(tables, false);
    const auto way = [&](double x) {
      return solver.join({&model, Vector3(x, 0.9, 0.8)}, {&model, Vector3(x, -0.9, 0.8)});
    };
    CHECK(way(0.12) != Status::converged);
    CHECK(way(0.6) == Status::converged);
  }
}
