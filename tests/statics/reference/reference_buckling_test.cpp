/// A pinned strut under an axial load P: two rigid halves of length a with a spring k about y between them.
/// Straight, with the middle kinked by 2w/a, it keeps k (2w/a)^2 / 2 and shortens by w^2/a: stable below P =
/// 2 k / a.
#include <Eigen/LU>
#include <cmath>

#include "counterflex/statics/chain.hpp"
#include "statics/support/reference_runs.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

constexpr double a = 0.2, k = 500, critical = 2 * k / a, k_along = 1e7;
const Pose home = translation({2 * a, 0, 0});

Load push(double P) {
  return {(Vector6() << -P, 0, 0, 0, 0, 0).finished()};
}

/// f(x) = 0 between `low` and `high`, where f changes its sign.
template <class Function>
double root(const Function& f, double low, double high) {
  const bool rising = f(high) > 0;
  for (int i = 0; i < 80; ++i) {
    const double middle = (low + high) / 2;
    (f(middle) > 0) == rising ? high = middle : low = middle;
  }
  return (low + high) / 2;
}

/// The load at which the straight state's reduced Hessian loses its definiteness.
double load_at_stability_limit(Bench& bench) {
  const Configuration nominal = bench.at(home);
  return root(
      [&](double P) {
        const Equilibrium straight = refine_forward(bench.model, nominal, push(P), all, bench.work);
        return stability(bench.model, straight.configuration, push(P), all, bench.work);
      },
      0.9 * critical, 1.1 * critical);
}

/// Half the kink above the critical load: al / sin(al) = P a / (2 k).
double half_kink(double P) {
  return root([&](double al) { return al / std::sin(al) - P * a / (2 * k); }, 1e-9, 3);
}

/// The strut bent by 2 al, its middle towards `side` (+1: +z, -1: -z), its spring not yet compressed.
Configuration bent(const Configuration& nominal, double P, double al, int side) {
  Configuration configuration = nominal;
  SeriesState& strut = configuration.chains[0];
  strut.x[1] = -side * al;     // pin; a positive rotation about y turns x towards -z
  strut.x[6] = side * 2 * al;  // kink
  strut.x[7] = -side * al;     // pin
  strut.F[0] = -P;
  configuration.X_MP.p.x() = 2 * a * std::cos(al);
  configuration.chains[1].x[0] = configuration.X_MP.p.x() - 2 * a;
  return configuration;
}

}  // namespace

TEST_CASE("a pinned strut is straight below 2k/a and is unstable above, close on both sides") {
  Bench bench(reference_machine("bar_buckling"));
  const Configuration nominal = bench.at(home);
  for (double part : {0.5, 0.99, 0.999}) {
    CAPTURE(part);
    const Equilibrium solved = solve_forward(bench.model, nominal, push(part * critical), all, bench.work);
    REQUIRE(solved.status == Status::converged);
    CHECK(std::abs(bench.tip(solved.configuration).p.x() - (2 * a - part * critical / k_along)) <
          length_tolerance);
  }
  for (double part : {1.001, 1.01, 1.05, 2.0}) {
    CAPTURE(part);
    CHECK(solve_forward(bench.model, nominal, push(part * critical), all, bench.work).status ==
          Status::unstable);
  }
}

TEST_CASE("the straight strut loses definiteness at 2k/a exactly, for any axial spring") {
  Bench bench(reference_machine("bar_buckling"));
  CHECK(std::abs(load_at_stability_limit(bench) - critical) < 1e-4);
}

// With springs k_x along and k_z across the strut, halves at angles a1, a2, b = a - P / k_x:
//     2 V = k_z (b a1 + a a2)^2 + k (a2 - a1)^2 + P (b a1^2 + 2 a a1 a2 - a a2^2)
TEST_CASE(
    "a spring softer along the strut than across moves the critical load as its second variation shows") {
  constexpr double k_x = 1e7, k_z = 4e7;
  const auto determinant = [&](double P) {
    const double b = a - P / k_x;
    Eigen::Matrix2d H;
    H << k_z * b * b + k + P * b, k_z * a * b - k + P * a, k_z * a * b - k + P * a, k_z * a * a + k - P * a;
    return H.determinant();
  };
  const double expected = root(determinant, 0.9 * critical, 1.1 * critical);
  CHECK(std::abs(expected - critical) > 4);
  Bench bench(reference_machine("bar_buckling_unequal"));
  CHECK(std::abs(load_at_stability_limit(bench) - expected) < 1e-4);
  const Configuration nominal = bench.at(home);
  CHECK(solve_forward(bench.model, nominal, push(0.999 * expected), all, bench.work).status ==
        Status::converged);
  CHECK(solve_forward(bench.model, nominal, push(1.001 * expected), all, bench.work).status ==
        Status::unstable);
}

TEST_CASE("the straight state above the critical load is an equilibrium, found and called unstable") {
  Bench bench(reference_machine("bar_buckling"));
  const Equilibrium straight = refine_forward(bench.model, bench.at(home), push(5250), all, bench.work);
  CHECK(straight.status == Status::unstable);
  CHECK(std::abs(bench.tip(straight.configuration).p.x() - 399.475 * mm) < length_tolerance);
}

TEST_CASE("the buckled strut is a stable equilibrium, reached from a buckled start on either side") {
  Bench bench(reference_machine("bar_buckling"));
  const Configuration nominal = bench.at(home);
  for (double part : {1.002, 1.05, 1.3})
    for (int side : {-1, 1}) {
      CAPTURE(part);
      CAPTURE(side);
      const double P = part * critical, al = half_kink(P);
      const Configuration start = bent(nominal, P, 0.97 * al, side);
      const Equilibrium solved = refine_forward(bench.model, start, push(P), all, bench.work);
      REQUIRE(solved.status == Status::converged);
      CHECK(std::abs(bench.tip(solved.configuration).p.x() - (2 * a * std::cos(al) - P / k_along)) <
            length_tolerance);
      CHECK(std::abs(solved.configuration.chains[0].x[6] - side * 2 * al) < angle_tolerance);
      CHECK(stability(bench.model, solved.configuration, push(P), all, bench.work) > 0);
    }
}

TEST_CASE("the buckled strut at 1.05 times the critical load has the numbers of an independent solver") {
  Bench bench(reference_machine("bar_buckling"));
  const Configuration start = bent(bench.at(home), 5250, 0.5, 1);
  const Equilibrium solved = refine_forward(bench.model, start, push(5250), all, bench.work);
  REQUIRE(solved.status == Status::converged);
  CHECK(std::abs(bench.tip(solved.configuration).p.x() - 342.884686212426 * mm) < length_tolerance);
  CHECK(std::abs(solved.configuration.chains[0].x[6] - 61.697432931097 * deg) < angle_tolerance);
}

TEST_CASE("the strut is compensated straight, and buckled where it starts so") {
  Bench bench(reference_machine("bar_buckling"));
  const Pose target = translation({398 * mm, 0, 0});
  const Configuration nominal = bench.at(target);
  const Equilibrium straight = solve_target(bench.model, nominal, target, push(2500), all, bench.work);
  REQUIRE(straight.status == Status::converged);
  CHECK(std::abs(actuator_values(bench.model.mechanism, straight.configuration)[0] + 1.75 * mm) <
        length_tolerance);
  Configuration start = bent(bench.at(home), 5250, 0.5, 1);
  const Equilibrium buckled = refine_target(bench.model, start, target, push(5250), all, bench.work);
  REQUIRE(buckled.status == Status::converged);
  CHECK(std::abs(actuator_values(bench.model.mechanism, buckled.configuration)[0] - 55.115313787574 * mm) <
        length_tolerance);
}

TEST_CASE(
    "the strut's ends do not show that it buckles: along them it is as stiff, across them it pushes, below "
    "and above") {
  Bench bench(reference_machine("bar_buckling"));
  const Configuration nominal = bench.at(home);
  for (double part : {0.5, 1.05}) {
    CAPTURE(part);
    const double P = part * critical;
    const Equilibrium straight = refine_forward(bench.model, nominal, push(P), all, bench.work);
    const ChainStiffness strut =
        chain_stiffness(bench.model, 0, straight.configuration.chains[0], all, bench.work);
    REQUIRE(strut.available);
    CHECK(strut.K_C(0, 0) == doctest::Approx(k_along).epsilon(1e-8));
    CHECK(strut.K_C(2, 2) == doctest::Approx(-P / (2 * a - P / k_along)).epsilon(1e-6));
  }
}
