/// Equilibrium of one chain at a given end pose: laws that follow from its energy.
#include "counterflex/statics/chain.hpp"

#include "statics/support/laws_support.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

// How far a chain's end is taken from where it is unloaded, with its errors.
constexpr double shift = 0.5e-3, turn = 1 * deg;
// The paper's iteration neglects Hessians; it needs smaller loads.
constexpr double of_paper = 0.04;
constexpr int steps = 8;

struct Solved {
  SeriesState state;
  Status status;
  int iterations;
};

Solved solve(const Model& model, std::size_t i, const Pose& X, const Configuration& start, ChainMethod method,
             StaticsWork& work) {
  Solved solved{start.chains[i], {}, 0};
  const Pose from = chain_end(model, i, start.chains[i], {}, work);
  // Half a millimetre is thousands of newtons: the end is led there, or Newton's way depends on rounding.
  for (int k = 1; k <= steps; ++k) {
    const Pose X_k = moved(from, static_cast<double>(k) / steps * difference(X, from));
    const auto result = solve_chain(model, i, k < steps ? X_k : X, {}, method, solved.state, work);
    solved.status = result.status;
    solved.iterations = result.iterations;
    if (result.status != Status::converged) break;
  }
  return solved;
}

double energy_at(const Model& model, std::size_t i, const Pose& X, const Configuration& start,
                 StaticsWork& work) {
  const Solved solved = solve(model, i, X, start, ChainMethod::newton, work);
  REQUIRE(solved.status == Status::converged);
  return elastic_energy(model.mechanism.chains[i], solved.state, {});
}

template <class Check>
void for_chains_at_random_ends(unsigned seed, int poses, const Check& check, double part = 1) {
  for (const Trial& trial : controlled_machines()) {
    CAPTURE(trial.name);
    const Model model = model_of(trial.name);
    StaticsWork work(model.mechanism);
    Random random(seed);
    for (int n = 0; n < poses; ++n) {
      CAPTURE(n);
      const Configuration nominal = somewhere(model, trial, random).configuration;
      for (std::size_t i = 0; i < model.mechanism.chains.size(); ++i) {
        CAPTURE(i);
        check(model, i,
              moved(chain_end(model, i, nominal.chains[i], {}, work), random.six(part * shift, part * turn)),
              nominal, work);
      }
    }
  }
}

}  // namespace

TEST_CASE("a chain's wrench is the gradient of its energy with respect to its end pose" *
          doctest::test_suite("long")) {
  for_chains_at_random_ends(
      7, 3,
      [](const Model& model, std::size_t i, const Pose& X, const Configuration& nominal, StaticsWork& work) {
        const double l = model.mechanism.length;
        Configuration solved = nominal;
        solved.chains[i] = solve(model, i, X, nominal, ChainMethod::newton, work).state;
        const Vector6 F = solved.chains[i].F;
        for (int k = 0; k < 6; ++k) {
          CAPTURE(k);
          const auto along = [&](double h) {
            return energy_at(model, i, moved(X, h * unit(k)), solved, work);
          };
          const double to_force = k < 3 ? 1 : 1 / l;
          const double scale = std::max(F.head<3>().norm(), F.tail<3>().norm() / l);
          CHECK(std::abs(central_difference(along, 2e-6) - F[k]) * to_force < 1e-7 * scale + 1e-5);
        }
      });
}

TEST_CASE("a solved chain ends where it is held and leaves no force on its free coordinates") {
  for_chains_at_random_ends(
      8, 2,
      [](const Model& model, std::size_t i, const Pose& X, const Configuration& nominal, StaticsWork& work) {
        const Solved solved = solve(model, i, X, nominal, ChainMethod::newton, work);
        REQUIRE(solved.status == Status::converged);
        CHECK(difference(chain_end(model, i, solved.state, {}, work), X).norm() < 2e-12);
        const Series& series = model.mechanism.chains[i];
        const Eigen::VectorXd JF =
            chain_jacobian(model, i, solved.state, {}, work).transpose() * solved.state.F;
        for (const Part& part : series.parts) {
          if (part.kind == PartKind::passive && part.k == 0) {
            CHECK(std::abs(JF[part.column]) < 1e-7);
          }
          if (part.kind != PartKind::spring) continue;
          const Vector6 tau = part.K * (solved.state.x.segment<6>(part.column) - part.theta_0);
          CHECK((JF.segment<6>(part.column) - tau).norm() < 1e-7 + 1e-9 * tau.norm());
        }
      });
}

TEST_CASE("actuators stay where they are while a chain is solved") {
  for_chains_at_random_ends(
      9, 1,
      [](const Model& model, std::size_t i, const Pose& X, const Configuration& nominal, StaticsWork& work) {
        Configuration after = nominal;
        after.chains[i] = solve(model, i, X, nominal, ChainMethod::newton, work).state;
        CHECK(actuator_values(model.mechanism, after) == actuator_values(model.mechanism, nominal));
      });
}

TEST_CASE(
    "the paper's iteration and Newton's find the same equilibrium, Newton's in fewer steps at large "
    "deflections") {
  int fewer = 0, found = 0, all = 0;
  for_chains_at_random_ends(
      10, 3,
      [&](const Model& model, std::size_t i, const Pose& X, const Configuration& nominal, StaticsWork& work) {
        const Solved newton = solve(model, i, X, nominal, ChainMethod::newton, work);
        const Solved paper = solve(model, i, X, nominal, ChainMethod::paper, work);
        REQUIRE(newton.status == Status::converged);
        ++all;
        if (paper.status != Status::converged) return;  // it need not, so far away
        CHECK((paper.state.F - newton.state.F).norm() < 1e-8 * newton.state.F.norm() + 1e-6);
        CHECK((paper.state.x - newton.state.x).cwiseAbs().maxCoeff() < 1e-9);
        fewer += newton.iterations < paper.iterations;
        ++found;
      });
  CHECK(fewer > all / 2);
  CHECK(found > all * 9 / 10);
}

TEST_CASE("a chain without load, error and preload is in its nominal configuration, without energy") {
  for (const Trial& trial : controlled_machines()) {
    CAPTURE(trial.name);
    const Model model = model_of(trial.name);
    StaticsWork work(model.mechanism);
    Random random(11);
    const Configuration nominal = somewhere(model, trial, random).configuration;
    for (std::size_t i = 0; i < model.mechanism.chains.size(); ++i) {
      SeriesState state = nominal.chains[i];
      const auto result =
          solve_chain(model, i, nominal.X_MP, nominal_stage, ChainMethod::newton, state, work);
      CHECK(result.status == Status::converged);
      CHECK(state.F.norm() < 1e-4);  // closures of 1e-12 m times stiffnesses of 1e8 N/m
      CHECK((state.x - nominal.chains[i].x).norm() < 1e-11);
      CHECK(elastic_energy(model.mechanism.chains[i], state, nominal_stage) < 1e-15);
    }
  }
}

TEST_CASE("a chain with one elastic joint has no equilibrium of its own: singular") {
  const Model model = model_of("arm");
  StaticsWork work(model.mechanism);
  SeriesState state = model.home.chains[0];
  const Pose X = moved(model.home.X_MP, 1e-3 * Vector6::Ones());
  CHECK(solve_chain(model, 0, X, {}, ChainMethod::newton, state, work).status == Status::singular);
  CHECK_FALSE(chain_stiffness(model, 0, model.home.chains[0], {}, work).available);
}

TEST_CASE("a chain held where no configuration of it is near does not converge") {
  const Model model = model_of("orthoglide_case_b");
  StaticsWork work(model.mechanism);
  SeriesState state = model.home.chains[0];
  const Pose X{exp_so3({2.5, 1, -1}), {3, -4, 5}};
  CHECK(solve_chain(model, 0, X, {}, ChainMethod::paper, state, work).status != Status::converged);
}

TEST_CASE("the energy of a series is that of its springs, sprung joints and branches") {
  const Model model = model_of_text(R"(controlled = []
[springs.s]
stiffness_diag_si = [100, 200, 300, 4, 5, 6]
preload_si = [0.1, 0, 0, 0, 0, 0]
[branches.b]
elements = [{ compliance = "prismatic", axis = "x", stiffness_N_per_m = 10 }, { spring = "s" }]
[[chain]]
name = "only"
elements = [
  { passive = "revolute", axis = "z", stiffness_Nm_per_rad = 7, preload_deg = 0 },
  { spring = "s" },
  { parallel = ["b", "b"] },
])");
  SeriesState state = zero_configuration(model.mechanism).chains[0];
  state.x[0] = 0.3;                                 // 7 0.3^2 / 2
  state.x.segment<6>(1) << 0.3, 0.1, 0, 0, 0.2, 0;  // (100 0.2^2 + 200 0.1^2 + 5 0.2^2) / 2
  state.groups[0].branches[0].x[0] = 0.5;           // 10 0.5^2 / 2; its spring is off its rest: 100 0.1^2 / 2
  const double springs = 0.5 * (7 * 0.09 + 100 * 0.04 + 200 * 0.01 + 5 * 0.04 + 10 * 0.25 + 2 * 100 * 0.01);
  CHECK(elastic_energy(model.mechanism.chains[0], state, {}) == doctest::Approx(springs).epsilon(1e-12));
}

TEST_CASE(
    "a stage scales preloads: springs as K (theta - s theta_0), sprung joints from their nominal values") {
  const Model model = model_of_text(R"(controlled = []
[springs.s]
stiffness_diag_si = [100, 200, 300, 4, 5, 6]
preload_si = [0.1, 0, 0, 0, 0, 0]
[[chain]]
name = "only"
elements = [{ passive = "prismatic", axis = "z", stiffness_N_per_m = 8, preload_mm = 500 }, { spring = "s" }])");
  SeriesState state = zero_configuration(model.mechanism).chains[0];
  state.x_nominal[0] = 0.25;
  state.x[0] = 0.25;
  for (double s : {0.0, 0.5, 1.0}) {
    CAPTURE(s);
    const double expected = 0.5 * 100 * 0.01 * s * s + 0.5 * 8 * 0.0625 * s * s;
    CHECK(elastic_energy(model.mechanism.chains[0], state, {1, 1, s}) ==
          doctest::Approx(expected).epsilon(1e-12));
  }
}
