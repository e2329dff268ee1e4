/// Loads in joints and springs, in the frames that the header promises.
#include "counterflex/statics/chain.hpp"
#include "statics/support/laws_support.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

std::vector<ChainLoads> loads_of(const Model& model, const Vector6& F, Configuration& configuration) {
  StaticsWork work(model.mechanism);
  const Equilibrium e = solve_forward(model, model.home, {F, true}, {}, work);
  REQUIRE(e.status == Status::converged);
  configuration = e.configuration;
  return loads(model.mechanism, model, configuration);
}

// A spring turned by 90 degrees about z, then two equal bars side by side whose springs are turned by 45
// degrees about y.
const char* const turned_springs = R"(controlled = []
[springs.first]
stiffness_diag_si = [1e6, 2e6, 3e6, 4e4, 5e4, 6e4]
preload_si = [1e-5, 0, 0, 0, 0, 0]
[springs.bar]
stiffness_diag_si = [1e9, 1e9, 1e9, 1e8, 1e8, 1e8]
[branches.bar]
elements = [{ rigid = { rpy_deg = [0, 45, 0] } }, { spring = "bar" }]
[[chain]]
name = "turned"
elements = [
  { rigid = { rpy_deg = [0, 0, 90] } },
  { spring = "first" },
  { rigid = { rpy_deg = [0, 0, -90] } },
  { parallel = ["bar", "bar"] },
])";

}  // namespace

TEST_CASE(
    "springs report deflection and load in their own frames, and a group its moment in its first spring's") {
  const Model model = model_of_text(turned_springs);
  Configuration c;
  const Vector6 F = (Vector6() << 300, 20, 10, 1, 2, 40).finished();
  const ChainLoads chain = loads_of(model, F, c).at(0);
  CHECK(chain.name == "turned");
  CHECK((chain.wrench - F).norm() < 1e-9);
  CHECK(chain[LoadKind::moment] == doctest::Approx(40).epsilon(1e-9));
  // 300 N along x of the machine is y of the spring (negative): 300 / 2e6; 40 N m about z: 40 / 6e4.
  CHECK(chain[LoadKind::spring_translation] == doctest::Approx(300 / 2e6).epsilon(0.01));
  CHECK(chain[LoadKind::spring_rotation] == doctest::Approx(40 / 6e4).epsilon(0.01));
  CHECK(chain[LoadKind::spring_force] == doctest::Approx(300).epsilon(0.01));
  CHECK(chain[LoadKind::spring_torque] == doctest::Approx(40).epsilon(0.01));
  const Vector3 moment = from_rpy({0, 45 * deg, 0}).transpose() * Vector3(1, 2, 40);
  CHECK(chain[LoadKind::group_moment] == doctest::Approx(largest_component(moment)).epsilon(0.01));
  CHECK(chain[LoadKind::group_moment] < 30);  // 40 / sqrt 2, not 40
  CHECK(chain[LoadKind::passive_change] == 0);
}

TEST_CASE("a spring's load is that beyond its preload") {
  const Model model = model_of_text(turned_springs);
  Configuration c;
  const ChainLoads chain = loads_of(model, Vector6::Zero(), c).at(0);
  CHECK(chain[LoadKind::spring_translation] == doctest::Approx(1e-5).epsilon(1e-6));
  CHECK(chain[LoadKind::spring_force] < 1e-6);
}

TEST_CASE("a compliance reports as a spring along or about its axis") {
  const Model turning = model_of("arm");
  Configuration c;
  const ChainLoads gear = loads_of(turning, 50 * unit(5), c).at(0);
  CHECK(gear[LoadKind::spring_torque] == doctest::Approx(50).epsilon(1e-9));
  CHECK(gear[LoadKind::spring_rotation] == doctest::Approx(50.0 / 5000).epsilon(1e-9));
  CHECK(gear[LoadKind::spring_force] == 0);
  const Model sliding = model_of_text(R"(controlled = []
[[chain]]
name = "s"
elements = [{ compliance = "prismatic", axis = [0, 3, 4], stiffness_N_per_m = 1e5 }])");
  const ChainLoads slide = loads_of(sliding, 100 * unit(2), c).at(0);
  CHECK(slide[LoadKind::spring_force] == doctest::Approx(80).epsilon(1e-9));
  CHECK(slide[LoadKind::spring_translation] == doctest::Approx(80 / 1e5).epsilon(1e-9));
  CHECK(slide[LoadKind::spring_torque] == 0);
}

TEST_CASE("passive revolute joints report their change from the nominal configuration, sliding ones do not") {
  const Model model = model_of_text(R"(controlled = []
[[chain]]
name = "p"
elements = [
  { passive = "revolute", axis = "z", stiffness_Nm_per_rad = 100, preload_deg = 30, home_deg = 30 },
  { passive = "prismatic", axis = "z", stiffness_N_per_m = 100 },
])");
  Configuration c;
  const ChainLoads chain = loads_of(model, 4 * unit(5) + 50 * unit(2), c).at(0);
  CHECK(c.chains[0].x[0] == doctest::Approx(30 * deg + 0.04).epsilon(1e-9));
  CHECK(chain[LoadKind::passive_change] == doctest::Approx(0.04).epsilon(1e-9));
}

TEST_CASE("loads are those of the chain and of all the branches inside it") {
  const Model model = model_of("orthoglide_case_b");
  Configuration c;
  const auto all = loads_of(model, 100 * unit(0) + 50 * unit(2), c);
  REQUIRE(all.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const SeriesState& state = c.chains[i];
    CHECK(all[i].wrench == state.F);
    double turned = 0;
    for (const SeriesState& branch : state.groups[0].branches)
      for (const Part& part : model.mechanism.chains[i].groups[0].branches[0].parts)
        if (part.kind == PartKind::passive)
          turned = std::max(turned, std::abs(branch.x[part.column] - branch.x_nominal[part.column]));
    CHECK(turned > 0);
    CHECK(all[i][LoadKind::passive_change] >= turned);
  }
}
