#include "counterflex/geometry/spectrum.hpp"
#include "counterflex/machine/machine.hpp"
#include "counterflex/statics/nominal.hpp"
#include "counterflex/statics/tip_stiffness.hpp"
#include "statics/support/laws_support.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

const std::string samples = COUNTERFLEX_SOURCE_DIR "/samples/";

Pose loaded_tip(const Model& model, const Configuration& from, const Load& load, StaticsWork& work) {
  const Equilibrium found = refine_forward(model, from, load, {}, work);
  REQUIRE(found.status == Status::converged);
  return tip(model.mechanism, found.configuration);
}

// Columns: the motion of the tip by a wrench of one component there.
Matrix6 difference_of_tips(const Model& model, const Configuration& at, const Load& load, StaticsWork& work) {
  Matrix6 C;
  for (int k = 0; k < 6; ++k) {
    const double h = k < 3 ? 1.0 : 0.1;
    C.col(k) = pose_difference(
        [&](double s) {
          return loaded_tip(model, at, {load.F + s * unit(k), false}, work);
        },
        h);
  }
  return C;
}

void check_compliance(const Model& model, const Configuration& nominal, const Load& load) {
  StaticsWork work(model.mechanism);
  const Equilibrium loaded = solve_forward(model, nominal, load, {}, work);
  REQUIRE(loaded.status == Status::converged);
  const auto C = compliance_at_tip(model, loaded.configuration, load, {}, work);
  REQUIRE(C);
  const Matrix6 expected = difference_of_tips(model, loaded.configuration, load, work);
  CAPTURE(*C);
  CAPTURE(expected);
  CHECK(size_in_units((*C - expected), 1 / model.mechanism.length) <
        1e-6 * size_in_units(expected, 1 / model.mechanism.length));
}

}  // namespace

TEST_CASE("the compliance at the tip is the derivative of the tip's pose by the wrench there") {
  for (const Trial& trial : controlled_machines()) {
    CAPTURE(trial.name);
    const Model model = model_of(trial.name);
    Random random(31);
    const Configuration nominal = somewhere(model, trial, random).configuration;
    check_compliance(model, nominal, {random.six(trial.force, trial.moment), false});
  }
}

TEST_CASE("a bending tool and a long rigid one are part of the compliance at the tip") {
  const Machine machine = load_machine(samples + "mill3/machine.toml");
  const Model base = prepare(machine);
  const Model bent =
      prepare_with_tool(machine, base, {.from = ToolStiffness::radial, .yields = radial_tool(2e6)});
  check_compliance(bent, bent.home, {(Vector6() << 30, -20, 10, 0, 0, 0).finished(), false});
  StaticsWork work(base.mechanism), bent_work(bent.mechanism);
  const auto stiff = compliance_at_tip(base, base.home, {}, nominal_stage, work);
  const auto soft = compliance_at_tip(bent, bent.home, {}, nominal_stage, bent_work);
  REQUIRE(stiff);
  REQUIRE(soft);
  const double added = (*soft - *stiff)(0, 0);
  CHECK(added == doctest::Approx(1 / 2e6).epsilon(1e-6));
}

// Source: an independent solver, a force at the tip of samples/robot-spindle at home.
TEST_CASE("a robot is softer at its tip than at its flange") {
  const Model model = prepare(load_machine(samples + "robot-spindle/machine.toml"));
  StaticsWork work(model.mechanism);
  const auto C = compliance_at_tip(model, model.home, {}, nominal_stage, work);
  REQUIRE(C);
  const Spectrum compliances = spectrum(Matrix3(C->topLeftCorner<3, 3>()));
  CHECK(1 / compliances.values[2] == doctest::Approx(0.590e6).epsilon(1e-3));
  CHECK(stiffness_along(*C, Vector3(compliances.vectors.col(2))) == doctest::Approx(0.590e6).epsilon(1e-3));
  const auto K = inverse_compliance(*C, model.mechanism.length);
  REQUIRE(K);
  CHECK((*K * *C).isApprox(Matrix6::Identity(), 1e-9));
}

TEST_CASE(
    "a chain without a stiffness of its own gives a compliance, and infinite stiffness where it is rigid") {
  const Model model = model_of_text(R"(
controlled = ["x"]
[tool]
xyz_mm = [0, 0, -100]
[[chain]]
name = "slide"
elements = [ { actuator = "prismatic", axis = "x" }, { compliance = "prismatic", axis = "y", stiffness_N_per_m = 4e6 } ]
)");
  StaticsWork work(model.mechanism);
  CHECK_FALSE(stiffness(model, model.home, {}, work).available);
  const auto C = compliance_at_tip(model, model.home, {}, {}, work);
  REQUIRE(C);
  CHECK(stiffness_along(*C, Vector3::UnitY()) == doctest::Approx(4e6).epsilon(1e-9));
  CHECK(std::isinf(stiffness_along(*C, Vector3::UnitX())));
  CHECK_FALSE(inverse_compliance(*C, model.mechanism.length));
}
