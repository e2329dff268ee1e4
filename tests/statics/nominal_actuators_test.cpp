/// Actuator values along a path, with lanes and without.
#include "counterflex/statics/nominal_actuators.hpp"

#include "lanes_support.hpp"

using namespace counterflex;
using namespace counterflex::laws;

TEST_CASE("actuator values along a path are those of inverse kinematics, from lanes and beside them") {
  for (const std::string name : {"orthoglide_case_b", "serial6r_link6", "hexapod_free_joints"}) {
    CAPTURE(name);
    LaneBench bench(machine_of(name));
    NominalActuators with_lanes, without;
    Random random(8);
    for (int i = 0; i < 20; ++i) {
      const Vector3 p = bench.home().p + random.vector(0.03);
      const NominalResult nominal = follow(bench.model, bench.model.home, {bench.home().R, p});
      REQUIRE(nominal.status == Status::converged);
      const Eigen::VectorXd wanted = actuator_values(bench.model.mechanism, nominal.configuration);
      const LaneMachine* lanes = i % 5 == 4 ? nullptr : &bench.machine;  // a tool that changes
      const auto a = with_lanes.at(bench.model, lanes, p), b = without.at(bench.model, nullptr, p);
      REQUIRE(a.has_value());
      REQUIRE(b.has_value());
      CHECK((*a - wanted).cwiseAbs().maxCoeff() < 1e-10);
      CHECK((*b - wanted).cwiseAbs().maxCoeff() < 1e-10);
    }
    CHECK(!with_lanes.at(bench.model, &bench.machine, Vector3(50, 0, 0)).has_value());
  }
}
