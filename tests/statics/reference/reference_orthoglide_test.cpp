/// The Orthoglide: assembly and milling line of the paper, finite rotations.
#include "statics/support/reference_runs.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

// Deviations (mm) at the two ends of the milling line, Q2 and Q5.
struct Line {
  Vector3 assembly_start, assembly_end, total_start, total_end;
};

Line milling_line(const std::string& machine) {
  Bench bench(reference_machine(machine));
  const Load cut{(Vector6() << 215, -10, -25, 1, 21.5, 0).finished()};
  const auto deviation_mm = [&](double y, const Load& load) {
    const Pose X_MT = translation(Vector3(-73.65, y, -73.65) * mm);
    const Equilibrium solved = solve_forward(bench.model, bench.at(X_MT), load, all, bench.work);
    REQUIRE(solved.status == Status::converged);
    return Vector3(bench.deviation(solved.configuration, X_MT).head<3>() / mm);
  };
  return {deviation_mm(-73.65, {}), deviation_mm(126.35, {}), deviation_mm(-73.65, cut),
          deviation_mm(126.35, cut)};
}

}  // namespace

TEST_CASE("the Orthoglide is after assembly where an independent solver finds it, with its chain wrenches") {
  check_cases("orthoglide_assembly", 10);
}

TEST_CASE("the Orthoglide's milling line is that of an independent solver: assembly, cut and compensation") {
  check_cases("orthoglide_line", 13);
}

TEST_CASE("case A of the milling line has the figures of the paper") {
  const Line line = milling_line("orthoglide_case_a");
  CHECK(std::abs(line.total_start.x() - 2.4) < 0.05);
  CHECK(std::abs(line.total_end.x() - 0.75) < 0.005);
  CHECK(std::abs(line.assembly_start.z() - 1.99) < 0.005);
  CHECK(std::abs(line.assembly_end.z() - 0.56) < 0.005);
}

TEST_CASE("case B of the milling line has the figures of the paper") {
  const Line line = milling_line("orthoglide_case_b");
  CHECK(std::abs(line.total_start.x() + 0.56) < 0.005);
  CHECK(std::abs(line.total_end.x() - 0.10) < 0.005);
  CHECK(std::abs(line.assembly_start.z() + 0.99) < 0.005);
  CHECK(std::abs(line.assembly_end.z() - 0.92) < 0.005);
}

TEST_CASE("case B's total x goes through zero near y = 80 mm") {
  Bench bench(reference_machine("orthoglide_case_b"));
  const auto total_x = [&](double y) {
    const Pose X_MT = translation(Vector3(-73.65, y, -73.65) * mm);
    const Load cut{(Vector6() << 215, -10, -25, 1, 21.5, 0).finished()};
    const Equilibrium solved = solve_forward(bench.model, bench.at(X_MT), cut, all, bench.work);
    REQUIRE(solved.status == Status::converged);
    return bench.deviation(solved.configuration, X_MT)[0];
  };
  CHECK(total_x(75) < 0);
  CHECK(total_x(85) > 0);
}
