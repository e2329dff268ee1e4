/// Loaded stiffness of chains (3)-(5) and of the manipulator (7), (18).
#include <Eigen/LU>

#include "counterflex/statics/chain.hpp"
#include "statics/support/laws_support.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

Equilibrium loaded(const Model& model, const Configuration& nominal, const Load& load, StaticsWork& work) {
  Equilibrium result = solve_forward(model, nominal, load, {}, work);
  REQUIRE(result.status == Status::converged);
  return result;
}

// Every machine, imperfect and loaded somewhere.
template <class Check>
void for_loaded_machines(unsigned seed, const Check& check) {
  for (const Trial& trial : controlled_machines()) {
    CAPTURE(trial.name);
    const Model model = model_of(trial.name);
    StaticsWork work(model.mechanism);
    Random random(seed);
    const Configuration nominal = somewhere(model, trial, random).configuration;
    const Load load = random.load(trial);
    check(model, loaded(model, nominal, load, work).configuration, load, work);
  }
}

SeriesState held(const Model& model, std::size_t i, const Configuration& configuration, const Vector6& step,
                 StaticsWork& work) {
  SeriesState state = configuration.chains[i];
  const Pose X = moved(configuration.X_MP, step);
  REQUIRE(solve_chain(model, i, X, {}, ChainMethod::newton, state, work).status == Status::converged);
  return state;
}

// The coordinates that rows of K_Cq and K_Ctheta speak of, in the order of the chain's columns.
std::pair<std::vector<int>, std::vector<int>> passive_and_elastic(const Series& series) {
  std::pair<std::vector<int>, std::vector<int>> columns;
  for (const Part& part : series.parts) {
    if (part.kind == PartKind::passive) columns.first.push_back(part.column);
    if (part.kind == PartKind::compliance) columns.second.push_back(part.column);
    for (int k = 0; part.kind == PartKind::spring && k < 6; ++k) columns.second.push_back(part.column + k);
  }
  return columns;
}

Matrix6 lower_right(const Matrix3& block) {
  Matrix6 K = Matrix6::Zero();
  K.bottomRightCorner<3, 3>() = block;
  return K;
}

}  // namespace

TEST_CASE("the loaded stiffness of a chain is the derivative of its wrench by its end pose") {
  for_loaded_machines(
      31, [](const Model& model, const Configuration& configuration, const Load&, StaticsWork& work) {
        for (std::size_t i = 0; i < model.mechanism.chains.size(); ++i) {
          CAPTURE(i);
          const ChainStiffness K = chain_stiffness(model, i, configuration.chains[i], {}, work);
          REQUIRE(K.available);
          Matrix6 expected;
          for (int k = 0; k < 6; ++k)
            expected.col(k) = central_difference(
                [&](double h) { return held(model, i, configuration, h * unit(k), work).F; }, 1e-5);
          const double l = model.mechanism.length;
          CHECK(size_in_units(K.K_C - expected, l) < 1e-6 * size_in_units(K.K_C, l));
        }
      });
}

TEST_CASE("K_Cq and K_Ctheta are the derivatives of joints and springs by the end pose") {
  for_loaded_machines(
      32, [](const Model& model, const Configuration& configuration, const Load&, StaticsWork& work) {
        for (std::size_t i = 0; i < model.mechanism.chains.size(); ++i) {
          CAPTURE(i);
          const ChainStiffness K = chain_stiffness(model, i, configuration.chains[i], {}, work);
          const auto [passive, elastic] = passive_and_elastic(model.mechanism.chains[i]);
          REQUIRE(K.K_Cq.rows() == static_cast<Eigen::Index>(passive.size()));
          REQUIRE(K.K_Ctheta.rows() == static_cast<Eigen::Index>(elastic.size()));
          for (int k = 0; k < 6; ++k) {
            const Eigen::VectorXd dx = central_difference(
                [&](double h) { return held(model, i, configuration, h * unit(k), work).x; }, 1e-5);
            for (std::size_t row = 0; row < passive.size(); ++row)
              CHECK(std::abs(K.K_Cq(static_cast<int>(row), k) - dx[passive[row]]) <
                    1e-6 * (1 + std::abs(dx[passive[row]])));
            for (std::size_t row = 0; row < elastic.size(); ++row)
              CHECK(std::abs(K.K_Ctheta(static_cast<int>(row), k) - dx[elastic[row]]) <
                    1e-6 * (1 + std::abs(dx[elastic[row]])));
          }
        }
      });
}

TEST_CASE("a loaded chain's stiffness is symmetric but for its rotational block: K - K' = -[m x]") {
  for_loaded_machines(
      33, [](const Model& model, const Configuration& configuration, const Load&, StaticsWork& work) {
        const double l = model.mechanism.length;
        for (std::size_t i = 0; i < model.mechanism.chains.size(); ++i) {
          CAPTURE(i);
          const Matrix6 K = chain_stiffness(model, i, configuration.chains[i], {}, work).K_C;
          const Vector3 m = configuration.chains[i].F.tail<3>();
          CHECK(size_in_units(K - K.transpose() + lower_right(skew(m)), l) < 1e-9 * size_in_units(K, l));
          CHECK((K - K.transpose()).bottomRightCorner<3, 3>().norm() > 0.5 * m.norm());
        }
      });
}

TEST_CASE("stiffness is symmetric at zero load") {
  for (const Trial& trial : controlled_machines()) {
    CAPTURE(trial.name);
    const Model model = model_of(trial.name);
    StaticsWork work(model.mechanism);
    Random random(34);
    for (int n = 0; n < 3; ++n) {
      const Configuration nominal = somewhere(model, trial, random).configuration;
      const ManipulatorStiffness K = stiffness(model, nominal, nominal_stage, work);
      REQUIRE(K.available);
      CHECK(size_in_units(K.K - K.K.transpose(), model.mechanism.length) <
            1e-10 * size_in_units(K.K, model.mechanism.length));
    }
  }
}

TEST_CASE("the manipulator's stiffness is the sum of its chains'") {
  for_loaded_machines(
      35, [](const Model& model, const Configuration& configuration, const Load&, StaticsWork& work) {
        Matrix6 sum = Matrix6::Zero();
        for (std::size_t i = 0; i < model.mechanism.chains.size(); ++i)
          sum += chain_stiffness(model, i, configuration.chains[i], {}, work).K_C;
        const Matrix6 K = stiffness(model, configuration, {}, work).K;
        CHECK((K - sum).norm() < 1e-12 * K.norm());
      });
}

TEST_CASE("the pose deflects under a wrench by the inverse of stiffness less the load's tangent") {
  for_loaded_machines(
      36, [](const Model& model, const Configuration& configuration, const Load& load, StaticsWork& work) {
        const Vector3 r =
            load.at_platform ? Vector3::Zero() : Vector3(configuration.X_MP.R * model.mechanism.X_PT.p);
        const Matrix6 tangent = lower_right(skew(load.F.head<3>()) * skew(r));  // of r x f as r turns
        const Matrix6 K = stiffness(model, configuration, {}, work).K - tangent;
        for (int k = 0; k < 6; ++k) {
          CAPTURE(k);
          const double h = k < 3 ? 1e-1 : 1e-2;
          const Vector6 dt = pose_difference(
              [&](double s) {
                const Equilibrium e =
                    refine_forward(model, configuration, {load.F + s * unit(k), load.at_platform}, {}, work);
                REQUIRE(e.status == Status::converged);
                return e.configuration.X_MP;
              },
              h);
          const Vector6 expected = K.fullPivLu().solve(wrench_at(unit(k), r));
          CHECK((dt - expected).norm() < 1e-4 * expected.norm());  // steps of 1e-7 m, solved to 1e-11
        }
      });
}

TEST_CASE("moving the reference point moves the stiffness as a change of twists and wrenches must") {
  const Vector3 d_P(0.05, -0.08, 0.12);  // from P to the new point Q
  for (const std::string name : {"orthoglide_case_b", "laws_mixed", "hexapod_joint_springs"}) {
    CAPTURE(name);
    Machine moved_machine = machine_of(name);
    for (Chain& chain : moved_machine.chains) chain.elements.push_back(Rigid{translation(d_P)});
    moved_machine.X_PT = translation(-d_P) * moved_machine.X_PT;
    moved_machine.home_X_MP = *moved_machine.home_X_MP * translation(d_P);
    const Model at_P = model_of(name), at_Q = prepare(moved_machine);
    StaticsWork work_P(at_P.mechanism), work_Q(at_Q.mechanism);
    const Load load{(Vector6() << 150, -90, 60, 3, 5, -4).finished(), false};
    const auto P = loaded(at_P, at_P.home, load, work_P).configuration;
    const auto Q = loaded(at_Q, at_Q.home, load, work_Q).configuration;
    CHECK(difference(tip(at_P.mechanism, P), tip(at_Q.mechanism, Q)).norm() < 1e-10);

    // v_P = v_Q + d x w, m_Q = m_P - d x f; d turns with the platform, so f's moment about Q turns too.
    const Vector3 d = P.X_MP.R * d_P;
    Vector3 f = Vector3::Zero();
    for (const SeriesState& chain : P.chains) f += chain.F.head<3>();
    Matrix6 T = Matrix6::Identity();
    T.topRightCorner<3, 3>() = skew(d);
    const Matrix6 expected =
        T.transpose() * stiffness(at_P, P, {}, work_P).K * T - lower_right(skew(f) * skew(d));
    const Matrix6 K = stiffness(at_Q, Q, {}, work_Q).K;
    CHECK(size_in_units(K - expected, 0.5) < 1e-8 * size_in_units(K, 0.5));
  }
}

TEST_CASE("a machine with a chain that has no stiffness of its own reports it") {
  const Model model = model_of("arm");
  StaticsWork work(model.mechanism);
  const ManipulatorStiffness K = stiffness(model, model.home, {}, work);
  CHECK_FALSE(K.available);
  CHECK(K.K.isZero(0));
}
