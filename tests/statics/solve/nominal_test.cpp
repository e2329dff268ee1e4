/// Nominal kinematics: the rigid, perfect machine.
#include "counterflex/statics/nominal.hpp"

#include <Eigen/LU>
#include <limits>

#include "counterflex/statics/chain.hpp"
#include "statics/support/laws_states.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

std::vector<int> components(const Model& model) {
  std::vector<int> list;
  for (Component c : model.mechanism.controlled) list.push_back(static_cast<int>(c));
  return list;
}

template <class Check>
void for_random_poses(unsigned seed, int count, const Check& check) {
  for (const Trial& trial : controlled_machines()) {
    CAPTURE(trial.name);
    const Model model = model_of(trial.name);
    Random random(seed);
    for (int n = 0; n < count; ++n) {
      CAPTURE(n);
      check(model, somewhere(model, trial, random).configuration, trial, random);
    }
  }
}

// Two links of 300 and 200 mm in a plane.
const char* const two_links = R"(controlled = ["x", "y"]
[[chain]]
name = "arm"
elements = [
  { actuator = "revolute", axis = "z", home_deg = 10, min_deg = -90, max_deg = 90 },
  { compliance = "revolute", axis = "z", stiffness_Nm_per_rad = 1000 },
  { rigid = { xyz_mm = [300, 0, 0] } },
  { actuator = "revolute", axis = "z", home_deg = 60 },
  { compliance = "revolute", axis = "z", stiffness_Nm_per_rad = 1000 },
  { rigid = { xyz_mm = [200, 0, 0] } },
])";

Pose in_plane(double x, double y) {
  return translation({x, y, 0});
}

std::string two_rigid_chains(double second_mm) {
  return "controlled = []\n[home]\nxyz_mm = [100, 0, 0]\n[springs.s]\nstiffness_diag_si = [1, 1, 1, 1, 1, "
         "1]\n"
         "[[chain]]\nname = \"a\"\nelements = [{ rigid = { xyz_mm = [100, 0, 0] } }, { spring = \"s\" }]\n"
         "[[chain]]\nname = \"b\"\nelements = [{ rigid = { xyz_mm = [" +
         std::to_string(second_mm) + ", 0, 0] } }, { spring = \"s\" }]\n";
}

}  // namespace

TEST_CASE(
    "inverse kinematics puts the tip on the controlled components and closes every chain without its "
    "springs") {
  for (const Trial& trial : controlled_machines()) {
    CAPTURE(trial.name);
    const Model model = model_of(trial.name);
    StaticsWork work(model.mechanism);
    Random random(91);
    for (int n = 0; n < 5; ++n) {
      Vector6 step = random.six(trial.reach, trial.turn);
      step.head<3>() += trial.centre;
      const Pose X_MT = moved(tip(model.mechanism, model.home), step);
      const NominalResult result = follow(model, model.home, X_MT);
      REQUIRE(result.status == Status::converged);
      const Vector6 d = deviation(tip(model.mechanism, result.configuration), X_MT);
      for (int c : components(model)) CHECK(std::abs(d[c]) < 1e-11);
      for (std::size_t i = 0; i < model.mechanism.chains.size(); ++i) {
        const SeriesState& state = result.configuration.chains[i];
        const Pose end = chain_end(model, i, state, nominal_stage, work);
        CHECK(difference(end, result.configuration.X_MP).norm() < 1e-11);
        CHECK(state.x == state.x_nominal);
        CHECK(state.F.isZero(0));
        for (const Part& part : model.mechanism.chains[i].parts)
          if (part.kind == PartKind::spring) CHECK(state.x.segment<6>(part.column).isZero(0));
      }
    }
  }
}

TEST_CASE("forward and inverse kinematics undo each other") {
  for_random_poses(92, 4, [](const Model& model, const Configuration& there, const Trial&, Random&) {
    const NominalResult forward = nominal_forward(model, model.home, actuator_values(model.mechanism, there));
    REQUIRE(forward.status == Status::converged);
    CHECK(largest_difference(forward.configuration, there) < 1e-9);
    CHECK(forward.configuration.chains[0].x == forward.configuration.chains[0].x_nominal);
    const NominalResult back = follow(model, forward.configuration, tip(model.mechanism, model.home));
    REQUIRE(back.status == Status::converged);
    CHECK(largest_difference(back.configuration, model.home) < 1e-9);
  });
}

TEST_CASE("the branch does not depend on the way that was taken through the work space") {
  for_random_poses(93, 2, [](const Model& model, const Configuration& a, const Trial& trial, Random& random) {
    const Configuration b = somewhere(model, trial, random).configuration;
    const NominalResult over = follow(model, a, tip(model.mechanism, b));
    REQUIRE(over.status == Status::converged);
    CHECK(largest_difference(over.configuration, b) < 1e-9);
  });
}

TEST_CASE("the actuator Jacobian is the derivative of the controlled components") {
  for_random_poses(94, 2, [](const Model& model, const Configuration& nominal, const Trial&, Random&) {
    const ActuatorJacobian jacobian = actuator_jacobian(model, nominal);
    const Eigen::VectorXd rho = actuator_values(model.mechanism, nominal);
    REQUIRE(jacobian.J.cols() == rho.size());
    CHECK(jacobian.condition < 1e3);
    CHECK(jacobian.condition >= 1);
    for (Eigen::Index a = 0; a < rho.size(); ++a) {
      CAPTURE(a);
      const Vector6 expected = pose_difference(
          [&](double h) {
            const auto there =
                nominal_forward(model, nominal, rho + h * Eigen::VectorXd::Unit(rho.size(), a));
            return tip(model.mechanism, there.configuration);
          },
          1e-4);
      const auto rows = components(model);
      for (std::size_t r = 0; r < rows.size(); ++r)
        CHECK(std::abs(jacobian.J(static_cast<int>(r), a) - expected[rows[r]]) < 1e-7);
    }
  });
}

TEST_CASE("the condition of the actuator Jacobian measures lengths in units of l") {
  const Model model = model_of_text(two_links);
  const ActuatorJacobian jacobian = actuator_jacobian(model, model.home);
  const Eigen::Vector2d sigma =
      Eigen::JacobiSVD<Eigen::Matrix2d>(jacobian.J).singularValues();  // both rows lengths
  CHECK(jacobian.condition == doctest::Approx(sigma[0] / sigma[1]).epsilon(1e-9));
}

TEST_CASE("a serial arm starts at its joints' homes and keeps its elbow on that side") {
  const Model model = model_of_text(two_links);
  CHECK(model.home_status == Status::converged);
  CHECK(actuator_values(model.mechanism, model.home).isApprox(Eigen::Vector2d(10 * deg, 60 * deg)));
  const NominalResult there = follow(model, model.home, in_plane(0.2, 0.35));
  REQUIRE(there.status == Status::converged);
  CHECK(actuator_values(model.mechanism, there.configuration)[1] > 0);
}

TEST_CASE("a target out of reach is unreachable") {
  const Model model = model_of_text(two_links);
  const Status status = follow(model, model.home, in_plane(0.6, 0)).status;
  CHECK((status == Status::unreachable || status == Status::singular));  // its edge is a singularity
  CHECK(follow(model_of("two_chains_equal"), model_of("two_chains_equal").home, in_plane(0.5, 0)).status ==
        Status::unreachable);
}

TEST_CASE("a segment through a fold of the arm is singular, not a jump to another branch") {
  // Equal links: straight through the first axis the arm would have to turn over.
  std::string text = two_links;
  text.replace(text.find("xyz_mm = [300"), 13, "xyz_mm = [200");
  const Model model = model_of_text(text);
  const NominalResult start = follow(model, model.home, in_plane(0.2, 0));
  REQUIRE(start.status == Status::converged);
  for (const double x : {-0.2, -0.13, -0.05, -0.011, -0.37}) {
    CAPTURE(x);
    CHECK(follow(model, start.configuration, in_plane(x, 0)).status == Status::singular);
  }
  CHECK(follow(model, start.configuration, in_plane(0, 0.2)).status == Status::converged);
}

TEST_CASE("a segment close beside a fold keeps its branch, or is refused" * doctest::test_suite("long")) {
  std::string text = two_links;
  text.replace(text.find("xyz_mm = [300"), 13, "xyz_mm = [200");
  const Model model = model_of_text(text);
  for (const double y : {0.05, 0.01, 0.001, 1e-5, -1e-5, -0.001, -0.01, -0.05})
    for (const double x : {-0.2, -0.13, -0.05}) {
      CAPTURE(x);
      CAPTURE(y);
      const NominalResult start = follow(model, model.home, in_plane(0.2, y));
      REQUIRE(start.status == Status::converged);
      REQUIRE(std::sin(actuator_values(model.mechanism, start.configuration)[1]) > 0);
      const NominalResult end = follow(model, start.configuration, in_plane(x, y));
      if (std::abs(y) > 0.005) CHECK(end.status == Status::converged);
      if (end.status == Status::converged)
        CHECK(std::sin(actuator_values(model.mechanism, end.configuration)[1]) > 0);
    }
}

TEST_CASE("a path from target to target is what following each from the last one is") {
  for_random_poses(95, 1, [](const Model& model, const Configuration&, const Trial& trial, Random& random) {
    NominalPath path(model, model.home);
    Configuration last = model.home;
    for (int n = 0; n < 4; ++n) {
      const Pose X_MT = tip(model.mechanism, somewhere(model, trial, random).configuration);
      const NominalResult one = follow(model, last, X_MT);
      CHECK(path.go_to(X_MT) == one.status);
      CHECK(largest_difference(path.configuration(), one.configuration) < 1e-9);
      last = one.configuration;
    }
  });
}

TEST_CASE("a path stays where it was when a target is not reached, and continues from there") {
  const Model model = model_of_text(two_links);
  NominalPath path(model, model.home);
  REQUIRE(path.go_to(in_plane(0.3, 0.2)) == Status::converged);
  const Configuration before = path.configuration();
  CHECK(path.go_to(in_plane(0.9, 0)) != Status::converged);
  CHECK(largest_difference(path.configuration(), before) < 1e-15);
  CHECK(path.go_to(in_plane(0.2, 0.3)) == Status::converged);
}

TEST_CASE("a target at the edge of reach, where the arm is straight, is singular") {
  const Model model = model_of_text(two_links);
  const NominalResult edge = follow(model, model.home, in_plane(0.5 - 1e-14, 0));
  CHECK(edge.status != Status::converged);
}

TEST_CASE("a home that misses its closures is unreachable, and the gap shows by how much") {
  CHECK(model_of_text(two_rigid_chains(100)).home_status == Status::converged);
  const Model model = model_of_text(two_rigid_chains(101));
  CHECK(model.home_status == Status::unreachable);
  CHECK(model.home_gap == doctest::Approx(1e-3).epsilon(1e-9));
}

TEST_CASE("the home pose of the file is that of the reference point") {
  for (const std::string name : {"hexapod_joint_springs", "orthoglide_perfect", "laws_mixed"}) {
    CAPTURE(name);
    const Machine machine = machine_of(name);
    const Model model = prepare(machine);
    CHECK(model.home_status == Status::converged);
    CHECK(model.home_gap < 1e-7);
    CHECK(difference(model.home.X_MP, *machine.home_X_MP).norm() == 0);
    CHECK(difference(tip(model.mechanism, model.home), model.home.X_MP * machine.X_PT).norm() < 1e-15);
  }
}

TEST_CASE("joints that are relaxed at home have their home values as rest values") {
  const Model model = model_of("hexapod_joint_springs");
  int relaxed = 0;
  for (std::size_t i = 0; i < model.mechanism.chains.size(); ++i)
    for (const Part& part : model.mechanism.chains[i].parts)
      if (part.rest_at_home) {
        CHECK(part.rest == model.home.chains[i].x[part.column]);
        relaxed += std::abs(part.rest) > 0.01;
      }
  CHECK(relaxed >= 6);
  StaticsWork work(model.mechanism);
  const Equilibrium e = solve_forward(model, model.home, {}, {0, 1, 1}, work);
  CHECK(difference(e.configuration.X_MP, model.home.X_MP).norm() < 1e-11);
}

TEST_CASE(
    "a machine's length is the mean distance of joints and springs from the reference point, at least 0.1 "
    "m") {
  CHECK(model_of("arm").mechanism.length ==
        doctest::Approx(1.2));  // actuator and compliance, both at the axis
  CHECK(model_of_text(R"(controlled = []
[[chain]]
name = "short"
elements = [{ passive = "revolute", axis = "z" }, { rigid = { xyz_mm = [10, 0, 0] } }])")
            .mechanism.length == 0.1);
}

TEST_CASE("the largest stiffness counts turning by the square of the machine's length") {
  CHECK(model_of("arm").mechanism.stiffest == doctest::Approx(5000 / 1.44));
  CHECK(model_of("two_chains_equal").mechanism.stiffest == doctest::Approx(4e6));
}

TEST_CASE("travel is watched at every actuator, ends included") {
  const Mechanism mechanism = model_of_text(two_links).mechanism;
  CHECK(within_travel(mechanism, Eigen::Vector2d(90 * deg, 100)));
  CHECK_FALSE(within_travel(mechanism, Eigen::Vector2d(90.001 * deg, 0)));
  CHECK_FALSE(within_travel(mechanism, Eigen::Vector2d(-91 * deg, 0)));
  CHECK_FALSE(within_travel(mechanism, Eigen::Vector2d(std::numeric_limits<double>::quiet_NaN(), 0)));
}

TEST_CASE("a platform that moves with its actuators held has a Jacobian of infinite condition") {
  const Model model = model_of_text(R"(controlled = ["x"]
[[chain]]
name = "loose"
elements = [{ actuator = "prismatic", axis = "x" }, { passive = "prismatic", axis = [1, 1, 0] }])");
  CHECK(std::isinf(actuator_jacobian(model, model.home).condition));
  CHECK(follow(model, model.home, in_plane(0.1, 0)).status == Status::singular);
}

TEST_CASE("deviation is the step of position and the rotation vector of actual times wanted transposed") {
  const Pose wanted{exp_so3({0.3, -0.2, 0.9}), {1, 2, 3}};
  const Pose actual{exp_so3({0, 0, 0.01}) * wanted.R, wanted.p + Vector3(1e-3, 0, -2e-3)};
  const Vector6 d = deviation(actual, wanted);
  CHECK((d - (Vector6() << 1e-3, 0, -2e-3, 0, 0, 0.01).finished()).norm() < 1e-14);
}
