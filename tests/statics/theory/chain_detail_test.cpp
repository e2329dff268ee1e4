#include "counterflex/statics/chain.hpp"
#include "counterflex/statics/theory.hpp"
#include "statics/support/laws_support.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

struct Linear {
  LinearResult result;
  std::vector<ChainDetail> chains;
};

Linear linear_details(const Model& model, const Configuration& nominal, const Load& load, StaticsWork& work) {
  Linear linear{linear_deviation(model, nominal, load, {}, work), {}};
  REQUIRE(linear.result.status == Status::converged);
  linear.chains = chain_details(model, nominal, linear.result.configuration, linear.result.dt_P,
                                {nominal, nominal_stage}, work);
  return linear;
}

}  // namespace

TEST_CASE(
    "by the linear theory every chain carries its stiffness times the motion that its errors leave it") {
  for (const char* name : {"orthoglide_case_a", "orthoglide_case_b", "serial6r_joints", "serial6r_link6"}) {
    CAPTURE(name);
    const Model model = model_of(name);
    StaticsWork work(model.mechanism);
    const Load load{(Vector6() << 120, -40, 60, 3, -2, 5).finished(), false};
    const Linear linear = linear_details(model, model.home, load, work);
    for (const ChainDetail& chain : linear.chains) {
      CAPTURE(chain.name);
      REQUIRE(chain.stiffness.available);
      REQUIRE(chain.dt);
      const Vector6 F = chain.stiffness.K_C * *chain.dt;  // (11), (14)
      CHECK((F - chain.wrench).norm() < 1e-7 * (1 + chain.wrench.norm()));
      CHECK((*chain.dt + *chain.eps - linear.result.dt_P).norm() < 1e-15);
    }
  }
}

// Source: an actuator that is 1 mm off along its axis x moves the end of its leg by 1 mm along that axis.
TEST_CASE("the errors of the paper's case A are 1 mm along every leg") {
  const Model model = model_of("orthoglide_case_a");
  StaticsWork work(model.mechanism);
  const auto eps = chain_eps(model, model.home, work);
  REQUIRE(eps.size() == 3);
  for (int i = 0; i < 3; ++i) {
    REQUIRE(eps[i]);
    CHECK((*eps[i] - 1e-3 * unit(i)).norm() < 1e-12);
  }
}

TEST_CASE("joints and springs move by (15) and (16): their rows times the motion that the errors leave") {
  const Model model = model_of("orthoglide_case_b");
  StaticsWork work(model.mechanism);
  const Linear linear =
      linear_details(model, model.home, {(Vector6() << 80, 0, -30, 0, 0, 0).finished(), false}, work);
  for (const ChainDetail& chain : linear.chains) {
    const Eigen::VectorXd dq = chain.stiffness.K_Cq * *chain.dt, theta = chain.stiffness.K_Ctheta * *chain.dt;
    REQUIRE(dq.size() == static_cast<Eigen::Index>(chain.passive.size()));
    REQUIRE(theta.size() == static_cast<Eigen::Index>(chain.elastic.size()));
    for (std::size_t r = 0; r < chain.passive.size(); ++r)
      CHECK(chain.coordinates[chain.passive[r]].change ==
            doctest::Approx(dq[static_cast<Eigen::Index>(r)]).epsilon(1e-9));
    for (std::size_t r = 0; r < chain.elastic.size(); ++r)
      CHECK(std::abs(chain.coordinates[chain.elastic[r]].value - theta[static_cast<Eigen::Index>(r)]) <
            1e-12);
  }
}

TEST_CASE("a chain's energy is the sum over its coordinates, and the stiffnesses of the chains add up") {
  for (const Trial& trial : controlled_machines()) {
    CAPTURE(trial.name);
    const Model model = model_of(trial.name);
    StaticsWork work(model.mechanism);
    Random random(77);
    const Configuration nominal = somewhere(model, trial, random).configuration;
    const Equilibrium loaded = solve_forward(model, nominal, random.load(trial), {}, work);
    REQUIRE(loaded.status == Status::converged);
    const auto chains =
        chain_details(model, nominal, loaded.configuration,
                      difference(loaded.configuration.X_MP, nominal.X_MP), {loaded.configuration, {}}, work);
    Matrix6 K = Matrix6::Zero();
    for (const ChainDetail& chain : chains) {
      K += chain.stiffness.K_C;
      CHECK(chain.energy >= 0);
      double twice = 0;  // springs without preload: tau' theta = theta' K theta
      bool relaxed = true;
      for (const CoordinateDetail& c : chain.coordinates) {
        if (c.kind == PartKind::passive && c.load != 0) relaxed = false;
        twice += c.load * c.value;
      }
      if (relaxed && trial.name != "laws_mixed")
        CHECK(twice == doctest::Approx(2 * chain.energy).epsilon(1e-9));
    }
    const ManipulatorStiffness sum = stiffness(model, loaded.configuration, {}, work);
    if (sum.available) CHECK((K - sum.K).norm() <= 1e-12 * sum.K.norm());
  }
}

TEST_CASE("a coordinate is named by the numbers of its elements, as check numbers them") {
  const Model model = model_of("orthoglide_case_b");
  StaticsWork work(model.mechanism);
  const auto chains = linear_details(model, model.home, {}, work).chains;
  const auto& list = chains.front().coordinates;
  CHECK(list.front().kind == PartKind::actuator);
  CHECK(list.front().element == "3");
  std::vector<std::string> springs;
  for (const CoordinateDetail& c : list)
    if (c.kind == PartKind::spring && c.component == 5) springs.push_back(c.element);
  CHECK(springs == std::vector<std::string>{"5", "7/upper_bar/4", "7/lower_bar/4"});
}
