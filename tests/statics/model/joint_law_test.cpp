// Elastic joints that are stiffer, or softer, above a load.
#include "statics/model/joint_law.hpp"

#include <cmath>

#include "counterflex/geometry/types.hpp"
#include "statics/support/batch_support.hpp"
#include "statics/support/laws_knees.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

/// A joint about z: 1000 N m/rad up to 20 N m, then 4000.
Model joint_with_knee() {
  return model_of_text(R"(controlled = []
[[chain]]
name = "joint"
elements = [
  { compliance = "revolute", axis = "z", stiffness_Nm_per_rad = 1000, knee_Nm = 20, stiffness_above_Nm_per_rad = 4000 },
  { rigid = { xyz_mm = [300, 0, 0] } },
]
)");
}

double angle_under(const Model& model, double moment) {
  StaticsWork work(model.mechanism);
  Load load;
  load.F[5] = moment;
  const Equilibrium found = solve_forward(model, model.home, load, {}, work);
  REQUIRE(found.status == Status::converged);
  return log_so3(tip(model.mechanism, found.configuration).R).z();
}

}  // namespace

TEST_CASE(
    "the force of a joint with a knee is the slope of its energy, and its stiffness that of the force") {
  for (const double change : {3000.0, -600.0}) {
    for (double x = -0.05; x <= 0.05; x += 0.00137) {
      CAPTURE(x);
      const double h = 1e-6;
      const auto energy = [&](double at) { return joint_energy(1000, change, 0.02, at); };
      const auto force = [&](double at) { return joint_force(1000, change, 0.02, at).force; };
      const JointForce<double> at = joint_force(1000, change, 0.02, x);
      CHECK(at.force == doctest::Approx((energy(x + h) - energy(x - h)) / (2 * h)).epsilon(1e-6));
      CHECK(at.stiffness == doctest::Approx((force(x + h) - force(x - h)) / (2 * h)).epsilon(1e-3));
      CHECK(at.force == -force(-x));
    }
    CHECK(joint_force(1000, change, 0.02, 0.01).force == doctest::Approx(10));
    CHECK(joint_force(1000, change, 0.02, 0.05).force == doctest::Approx(20 + 0.03 * (1000 + change)));
    CHECK(joint_force(1000, change, 0.02, 0.0179999).force == doctest::Approx(17.9999));
  }
}

TEST_CASE("a joint with a knee turns along its two lines, with a smooth corner") {
  const Model model = joint_with_knee();
  for (const double sign : {1.0, -1.0}) {
    CHECK(angle_under(model, sign * 10) / (sign * 0.010) == doctest::Approx(1).epsilon(1e-9));
    CHECK(angle_under(model, sign * 60) / (sign * 0.030) == doctest::Approx(1).epsilon(1e-9));
    // At the deflection of the knee the parabola is w / 4 times the change of stiffness above the corner.
    CHECK(angle_under(model, sign * (20 + 3000 * 0.002 / 4)) / (sign * 0.020) ==
          doctest::Approx(1).epsilon(1e-9));
  }
}

TEST_CASE("batches: machines whose joints have knees are solved as single waypoints are") {
  for (const std::string name : {"robot-ur10", "robot-spindle"}) {
    for (const double factor : {3.0, 0.4}) {
      CAPTURE(name);
      CAPTURE(factor);
      const Machine linear = sample_machine(name + "/machine");
      BatchBench bench(with_knees(linear, 60, factor)), straight(linear);
      Random random(5);
      const Trial trial{name, 0.05, 0, 300, 20};
      int solved = 0;
      double difference = 0;
      for (int i = 0; i < 6; ++i) {
        const auto requests = cluster(bench, trial, random, 5, 0.004);
        for (const BatchQuestion question : {BatchQuestion::forward, BatchQuestion::target}) {
          const auto answers = bench.solve(question, whole, requests);
          const auto others = straight.solve(question, whole, requests);
          for (std::size_t k = 0; k < answers.size(); ++k) {
            if (!answers[k].solved) continue;
            ++solved;
            check_answer(bench, question, whole, requests[k], answers[k], 1e-10);
            if (question == BatchQuestion::forward)
              difference = std::max(difference, (answers[k].X_MT.p - others[k].X_MT.p).norm());
          }
        }
      }
      if (factor > 1)
        CHECK(solved >= 54);  // of joints that soften many are left to the solver of single waypoints
      CHECK(difference > 1e-5);
    }
  }
}
