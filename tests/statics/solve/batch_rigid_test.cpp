/// Rigid machines in batches.
#include "statics/support/batch_support.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

// Without springs, compliances and the springs of passive joints.
Machine made_rigid(Machine machine) {
  for (Chain& chain : machine.chains) {
    std::erase_if(chain.elements, [](const Element& element) {
      return std::holds_alternative<Spring>(element) || std::holds_alternative<Compliance>(element);
    });
    for (Element& element : chain.elements)
      if (Passive* passive = std::get_if<Passive>(&element)) passive->stiffness = 0;
  }
  return machine;
}

struct RigidTrial {
  Machine machine;
  Vector3 centre;  // from home (m)
};

std::vector<RigidTrial> rigid_trials() {
  return {{made_rigid(sample_machine("mill3/machine")), {0.2, 0.12, -0.1}},
          {made_rigid(machine_of("serial6r_link6")), Vector3::Zero()},
          {made_rigid(machine_of("hexapod_free_joints")), Vector3::Zero()},
          {made_rigid(sample_machine("robot-spindle/machine")), Vector3::Zero()}};
}

// The mill, and a chain of free slides beside it that ends where the mill's does if nothing is skew.
Machine mill_beside_slides(const Pose& skew) {
  Machine machine = made_rigid(sample_machine("mill3/machine"));
  for (Element& element : machine.chains[0].elements)
    if (AssemblyError* error = std::get_if<AssemblyError>(&element)) error->X = {};
  Chain slides;
  slides.name = "slides";
  for (int axis = 0; axis < 3; ++axis)
    slides.elements.push_back(Passive{.joint = {JointKind::prismatic, Vector3::Unit(axis)}});
  slides.elements.push_back(AssemblyError{.X = skew});
  machine.chains.push_back(slides);
  return machine;
}

}  // namespace

TEST_CASE("batches: every waypoint of a rigid machine is solved, as the solver of single waypoints does") {
  for (const RigidTrial& trial : rigid_trials()) {
    CAPTURE(trial.machine.name);
    BatchBench bench(trial.machine);
    Random random(21);
    std::vector<BatchRequest> requests;
    for (int i = 0; i < 5; ++i)
      requests.push_back({{bench.home().p + trial.centre + random.vector(0.004)}, random.six(500, 30)});
    for (const BatchQuestion question : {BatchQuestion::forward, BatchQuestion::target})
      for (const Stage& stage : {whole, without_errors}) {
        const auto answers = bench.solve(question, stage, requests);
        for (std::size_t k = 0; k < answers.size(); ++k) {
          REQUIRE(answers[k].solved);
          check_answer(bench, question, stage, requests[k], answers[k], 1e-10);
        }
      }
  }
}

TEST_CASE(
    "batches: the solver of single waypoints starts from the nominal configuration of a rigid machine's "
    "cell") {
  BatchBench bench(made_rigid(sample_machine("mill3/machine")));
  const Vector3 p = bench.home().p + Vector3(0.2, 0.12, -0.1);
  const Configuration* near = bench.solver.nominal_near(p);
  REQUIRE(near != nullptr);
  const NominalResult nominal = follow(bench.model, *near, {bench.home().R, p});
  REQUIRE(nominal.status == Status::converged);
  CHECK(solve_forward(bench.model, nominal.configuration, {}, {}, bench.work).status == Status::converged);
}

TEST_CASE("batches: a rigid machine whose errors no pose can meet is not solved") {
  const auto is_solved = [](const Pose& skew) {
    BatchBench bench(mill_beside_slides(skew));
    REQUIRE(bench.model.home_status == Status::converged);
    const BatchRequest request{{bench.home().p + Vector3(0.2, 0.12, -0.1)}, Vector6::Zero()};
    return bench.solve(BatchQuestion::forward, whole, {request})[0].solved;
  };
  CHECK(is_solved({}));
  CHECK(!is_solved(rotation(exp_so3(Vector3(1e-6, 0, 0)))));
}
