/// Machines simple enough for a formula.
#include <Eigen/LU>

#include "statics/support/reference_runs.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE(
    "cantilever, arm, parallel bars and two chains agree with their formulas or an independent solver") {
  check_cases("closed_forms", 23);
}

TEST_CASE("two clamped bars have the stiffness of the textbook, as two chains and as a group") {
  constexpr double L = 0.5, d = 0.08, EA = 4e7, GJ = 3000, EIy = 5000, EIz = 8000;
  Matrix6 K = Matrix6::Zero();
  K.diagonal() << 2 * EA / L, 24 * EIz / (L * L * L), 24 * EIy / (L * L * L),
      2 * GJ / L + d * d / 2 * 12 * EIz / (L * L * L), 8 * EIy / L + d * d / 2 * EA / L, 8 * EIz / L;
  K(1, 5) = K(5, 1) = -12 * EIz / (L * L);
  K(2, 4) = K(4, 2) = 12 * EIy / (L * L);
  for (const char* name : {"parallel_bars_two_chains", "parallel_bars_group"}) {
    CAPTURE(name);
    Bench bench(perfect(reference_machine(name)));
    const ManipulatorStiffness found = stiffness(bench.model, bench.model.home, all, bench.work);
    REQUIRE(found.available);
    CHECK((found.K - K).cwiseAbs().maxCoeff() < 1e-9 * K.maxCoeff());
  }
}

TEST_CASE("a bar that is too long pulls its neighbour with the force of an independent solver") {
  Bench bench(reference_machine("parallel_bars_two_chains"));
  const Equilibrium solved = solve_forward(bench.model, bench.model.home, {}, all, bench.work);
  REQUIRE(solved.status == Status::converged);
  const Vector6 theta = spring_deflections(bench.model, solved.configuration)[0];
  constexpr double EA_L = 4e7 / 0.5;
  CHECK(EA_L * theta[0] == doctest::Approx(144.92756808384).epsilon(1e-9));
}

TEST_CASE("the first-order shift of two coupled chains is wrong by the square of their error") {
  Bench bench(reference_machine("two_chains_coupled"));
  Matrix6 sum = Matrix6::Zero(), K_first = Matrix6::Zero();
  for (const Series& chain : bench.model.mechanism.chains)
    for (const Part& part : chain.parts)
      if (part.kind == PartKind::spring) {
        if (K_first.isZero()) K_first = part.K;
        sum += part.K;
      }
  const Vector6 e = (Vector6() << Vector3(0.4, -0.3, 0.5) * mm, Vector3(0.3, -0.2, 0.25) * deg).finished();
  const auto miss = [&](double scale) {
    const Equilibrium solved = solve_forward(bench.model, bench.model.home, {}, {scale, 1, 1}, bench.work);
    REQUIRE(solved.status == Status::converged);
    const Vector6 first_order = sum.inverse() * K_first * (scale * e);  // (13)
    return (bench.deviation(solved.configuration, bench.tip(bench.model.home)) - first_order).norm();
  };
  CHECK(miss(1) > 1e-7);
  CHECK(miss(1) / miss(0.5) == doctest::Approx(4).epsilon(0.02));
  CHECK(miss(0.5) / miss(0.25) == doctest::Approx(4).epsilon(0.02));
}

TEST_CASE("a beam bent by a moment about its axis of bending turns in proportion, however far") {
  Bench bench(perfect(reference_machine("cantilever")));
  const Equilibrium solved = solve_forward(bench.model, bench.model.home,
                                           {(Vector6() << 0, 0, 0, 0, 0, 16000).finished()}, all, bench.work);
  REQUIRE(solved.status == Status::converged);
  CHECK(bench.deviation(solved.configuration, bench.tip(bench.model.home))[5] ==
        doctest::Approx(1).epsilon(1e-9));
}
