/// Jacobian and Hessian of series far from equilibrium, against central differences.
#include "counterflex/statics/chain.hpp"
#include "statics/support/laws_states.hpp"
#include "statics/support/laws_tables.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

// The state with a step `h` in column `c`; a group's columns are a spatial twist of its end.
SeriesState stepped(const Series& series, SeriesState state, int c, double h) {
  for (const Part& part : series.parts) {
    if (part.kind != PartKind::group || c < part.column || c >= part.column + 6) continue;
    Pose& X = state.groups[static_cast<std::size_t>(part.group)].X;
    X = moved(X, h * unit(c - part.column));
    return state;
  }
  state.x[c] += h;
  return state;
}

// All chains of a machine, and the branches of its groups made chains, in random states.
template <class Check>
void for_shaken_chains(unsigned seed, const Check& check) {
  for (const std::string name :
       {"orthoglide_case_b", "hexapod_joint_springs", "serial6r_link6", "laws_mixed", "cantilever", "arm"}) {
    for (const double tables : {0.0, 1.0}) {
      CAPTURE(name);
      CAPTURE(tables);
      const Machine machine = machine_of(name);
      const Model model = prepare(tables > 0 ? with_tables(machine, tables) : machine);
      StaticsWork work(model.mechanism);
      Random random(seed);
      for (std::size_t i = 0; i < model.mechanism.chains.size(); ++i) {
        CAPTURE(i);
        const SeriesState state = shaken(model.mechanism.chains[i], model.home.chains[i], random);
        check(model, i, state, work);
      }
    }
  }
}

}  // namespace

TEST_CASE("the geometric Jacobian of a chain is the derivative of its end pose") {
  for_shaken_chains(21, [](const Model& model, std::size_t i, const SeriesState& state, StaticsWork& work) {
    const Series& series = model.mechanism.chains[i];
    const Eigen::MatrixXd J = chain_jacobian(model, i, state, {}, work);
    REQUIRE(J.cols() == series.columns);
    for (int c = 0; c < series.columns; ++c) {
      CAPTURE(c);
      const Vector6 expected = pose_difference(
          [&](double h) { return chain_end(model, i, stepped(series, state, c, h), {}, work); }, 1e-4);
      CHECK((J.col(c) - expected).norm() < 1e-11);
    }
  });
}

TEST_CASE("the Hessian of a chain is the derivative of J'F with the wrench held") {
  for_shaken_chains(22, [](const Model& model, std::size_t i, const SeriesState& state, StaticsWork& work) {
    const Series& series = model.mechanism.chains[i];
    const Eigen::MatrixXd H = chain_hessian(model, i, state, {}, work);
    REQUIRE(H.rows() == series.columns);
    for (int c = 0; c < series.columns; ++c) {
      CAPTURE(c);
      const Eigen::VectorXd expected = central_difference(
          [&](double h) -> Eigen::VectorXd {
            return chain_jacobian(model, i, stepped(series, state, c, h), {}, work).transpose() * state.F;
          },
          1e-4);
      Eigen::VectorXd miss = H.col(c) - expected;
      if (series.screws[static_cast<std::size_t>(c)]) miss[c] = 0;  // no equation has this entry
      CHECK(miss.cwiseAbs().maxCoeff() < 1e-8);                     // entries are of hundreds of N, N m
    }
  });
}

TEST_CASE("the asymmetry of the Hessian is m . (w_k x w_j) between any two coordinates") {
  for_shaken_chains(23, [](const Model& model, std::size_t i, const SeriesState& state, StaticsWork& work) {
    const Series& series = model.mechanism.chains[i];
    const Eigen::MatrixXd H = chain_hessian(model, i, state, {}, work);
    const Eigen::MatrixXd w = chain_jacobian(model, i, state, {}, work).bottomRows(3);
    const Vector3 m = state.F.tail<3>();
    std::vector<int> coordinates;  // a group's twist is not a coordinate
    for (const Part& part : series.parts) {
      if (part.column < 0 || part.kind == PartKind::group) continue;
      for (int k = 0; k < (part.kind == PartKind::spring ? 6 : 1); ++k)
        coordinates.push_back(part.column + k);
    }
    for (int j : coordinates)
      for (int k : coordinates) {
        const double expected = m.dot(Vector3(w.col(k)).cross(Vector3(w.col(j))));
        CHECK(std::abs(H(j, k) - H(k, j) - expected) < 1e-10);
      }
  });
}

TEST_CASE("the Hessian vanishes without a wrench") {
  for_shaken_chains(24, [](const Model& model, std::size_t i, SeriesState state, StaticsWork& work) {
    state.F.setZero();
    CHECK(chain_hessian(model, i, state, {}, work).isZero(0));
  });
}

TEST_CASE("errors of a stage are a part s of the translation and Exp(s Log R) of the rotation") {
  const Model model = model_of_text(R"(controlled = []
[[chain]]
name = "only"
errors.e = { xyz_mm = [10, 20, 30], rotvec_deg = [0, 0, 80] }
elements = [{ error = "e" }, { passive = "prismatic", axis = "x" }])");
  StaticsWork work(model.mechanism);
  for (double s : {0.0, 0.25, 1.0}) {
    CAPTURE(s);
    const Pose end = chain_end(model, 0, model.home.chains[0], {s, 1, 1}, work);
    CHECK((end.p - s * Vector3(0.01, 0.02, 0.03)).norm() < 1e-15);
    CHECK((end.R - exp_so3({0, 0, s * 80 * deg})).norm() < 1e-14);
  }
}
