/// Batches against the solver of single waypoints.
#include "counterflex/geometry/pose.hpp"
#include "statics/support/batch_support.hpp"
#include "statics/support/laws_states.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

constexpr double answer_tolerance = 1e-10;  // m, rad

// Solves clusters of neighbours and checks every answer; the share that was solved.
double check_clusters(const BatchTrial& batch_trial, const Stage& stage, int clusters, unsigned seed) {
  BatchBench bench(batch_trial.machine, batch_trial.at_platform);
  Random random(seed);
  int asked = 0, solved = 0;
  for (int i = 0; i < clusters; ++i) {
    const auto requests = cluster(bench, batch_trial.trial, random, 5, 0.004);
    for (const BatchQuestion question : {BatchQuestion::forward, BatchQuestion::target}) {
      const auto answers = bench.solve(question, stage, requests);
      for (std::size_t k = 0; k < answers.size(); ++k, ++asked) {
        if (!answers[k].solved) continue;
        ++solved;
        check_answer(bench, question, stage, requests[k], answers[k], answer_tolerance);
      }
    }
  }
  return static_cast<double>(solved) / asked;
}

}  // namespace

TEST_CASE("batches: every waypoint is solved, to the equilibrium of the solver of single waypoints" *
          doctest::test_suite("long")) {
  for (const BatchTrial& batch_trial : batch_trials()) {
    CAPTURE(batch_trial.trial.name);
    CAPTURE(batch_trial.at_platform);
    CHECK(check_clusters(batch_trial, whole, 2, 3) == 1);
  }
}

TEST_CASE("batches: 500 places in the work space of each machine are solved, each in a cell of its own" *
          doctest::test_suite("long")) {
  for (const BatchTrial& batch_trial : batch_trials()) {
    CAPTURE(batch_trial.trial.name);
    BatchBench bench(batch_trial.machine, batch_trial.at_platform);
    Random random(23);
    std::vector<BatchRequest> requests;
    for (int i = 0; i < 500; ++i)
      for (const BatchRequest& request : cluster(bench, batch_trial.trial, random, 1, 0))
        requests.push_back(request);
    const auto answers = bench.solve(BatchQuestion::target, whole, requests);
    const auto solved = std::count_if(answers.begin(), answers.end(),
                                      [](const BatchAnswer& answer) { return answer.solved; });
    CHECK(solved == 500);
    for (std::size_t k = 0; k < answers.size(); k += 50)
      check_answer(bench, BatchQuestion::target, whole, requests[k], answers[k], answer_tolerance);
  }
}

TEST_CASE("batches: machines without their assembly errors are solved as single waypoints are") {
  for (const std::string name : {"orthoglide_case_b", "hexapod_joint_springs", "serial6r_link6"}) {
    CAPTURE(name);
    for (const BatchTrial& batch_trial : batch_trials())
      if (batch_trial.trial.name == name) {
        CHECK(check_clusters(batch_trial, without_errors, 1, 5) == 1);
        break;
      }
  }
}

TEST_CASE(
    "batches: where the actuators of commands are known, tips are the same, and in other actuators others") {
  for (const BatchTrial& batch_trial : batch_trials()) {
    CAPTURE(batch_trial.trial.name);
    BatchBench bench(batch_trial.machine, batch_trial.at_platform);
    Random random(13);
    const auto requests = cluster(bench, batch_trial.trial, random, 6, 0.004);
    const auto commands = bench.solve(BatchQuestion::forward, whole, requests);
    std::vector<BatchRequest> known = requests;
    for (std::size_t k = 0; k < known.size(); ++k) {
      REQUIRE(commands[k].solved);
      known[k].rho = &commands[k].rho;
    }
    for (const Stage& stage : {whole, without_errors}) {
      const auto expected = bench.solve(BatchQuestion::forward, stage, requests),
                 answers = bench.solve(BatchQuestion::forward, stage, known);
      for (std::size_t k = 0; k < known.size(); ++k) {
        REQUIRE(answers[k].solved);
        CHECK(difference(answers[k].X_MT, expected[k].X_MT).norm() < 1e-11);
      }
    }
    const Eigen::VectorXd moved = commands[0].rho + Eigen::VectorXd::Constant(commands[0].rho.size(), 1e-4);
    known[0].rho = &moved;
    const auto answers = bench.solve(BatchQuestion::forward, whole, known);
    CHECK(difference(answers[0].X_MT, commands[0].X_MT).norm() > 1e-5);
  }
}

TEST_CASE(
    "batches: a command is the nominal position of the actuators that bring the tip to the wanted place") {
  BatchBench bench(machine_of("orthoglide_case_b"));
  Random random(7);
  const auto requests = cluster(bench, batch_trials()[1].trial, random, 8, 0.005);
  const auto answers = bench.solve(BatchQuestion::target, whole, requests);
  for (std::size_t k = 0; k < requests.size(); ++k) {
    REQUIRE(answers[k].solved);
    const Pose wanted{bench.home().R, requests[k].at.p};
    const NominalResult nominal = follow(bench.model, bench.model.home, wanted);
    const Equilibrium alone =
        solve_target(bench.model, nominal.configuration, wanted, {requests[k].F}, {}, bench.work);
    REQUIRE(alone.status == Status::converged);
    const NominalResult commanded = nominal_forward(
        bench.model, nominal.configuration, actuator_values(bench.model.mechanism, alone.configuration));
    CHECK((tip(bench.model.mechanism, commanded.configuration).p - answers[k].command.p).norm() <=
          answer_tolerance);
  }
}

TEST_CASE(
    "batches: orientations that are commanded are those of the nominal tip, on any machine that controls "
    "them") {
  int solved = 0;
  for (const std::string name : {"hexapod_joint_springs", "serial6r_link6", "serial6r_joints"}) {
    CAPTURE(name);
    BatchBench bench(machine_of(name));
    Random random(17);
    const Vector3 centre = bench.home().p;
    std::vector<BatchRequest> requests;
    for (int i = 0; i < 6; ++i) {
      const Vector3 p = centre + random.vector(0.02);
      const Vector6 F = random.six(50, 2);
      requests.push_back({{p, random.vector(0.1)}, F});
    }
    for (const BatchQuestion question : {BatchQuestion::target, BatchQuestion::forward}) {
      const auto answers = bench.solve(question, whole, requests);
      for (std::size_t k = 0; k < requests.size(); ++k) {
        if (!answers[k].solved) continue;
        ++solved;
        const Pose command{exp_so3(requests[k].at.turn) * bench.home().R, answers[k].command.p};
        const NominalResult nominal = follow(bench.model, bench.model.home, command);
        REQUIRE(nominal.status == Status::converged);
        const Equilibrium alone =
            solve_forward(bench.model, nominal.configuration, {requests[k].F}, {}, bench.work);
        REQUIRE(alone.status == Status::converged);
        CHECK(deviation(answers[k].X_MT, tip(bench.model.mechanism, alone.configuration))
                  .cwiseAbs()
                  .maxCoeff() <= answer_tolerance);
        if (question == BatchQuestion::target)
          CHECK((answers[k].X_MT.p - requests[k].at.p).norm() <= answer_tolerance);
      }
    }
  }
  CHECK(solved >= 34);  // of 36
}

TEST_CASE("batches: a command for a whole pose is that of the solver of single waypoints") {
  int solved = 0;
  for (const std::string name : {"hexapod_joint_springs", "serial6r_link6", "serial6r_joints"}) {
    CAPTURE(name);
    BatchBench bench(machine_of(name));
    Random random(23);
    const Vector3 centre = bench.home().p;
    std::vector<BatchRequest> requests;
    for (int i = 0; i < 8; ++i) {
      const Vector3 p = centre + random.vector(0.02);
      const Vector6 F = random.six(50, 2);
      requests.push_back({{p, random.vector(i < 4 ? 0.1 : 0.5)}, F});
    }
    const auto answers = bench.solve(BatchQuestion::pose, whole, requests);
    for (std::size_t k = 0; k < requests.size(); ++k) {
      if (!answers[k].solved) continue;
      ++solved;
      const Pose wanted{exp_so3(requests[k].at.turn) * bench.home().R, requests[k].at.p};
      const NominalResult nominal = follow(bench.model, bench.model.home, wanted);
      const Equilibrium alone =
          solve_target(bench.model, nominal.configuration, wanted, {requests[k].F}, {}, bench.work);
      REQUIRE(alone.status == Status::converged);
      const NominalResult commanded = nominal_forward(
          bench.model, nominal.configuration, actuator_values(bench.model.mechanism, alone.configuration));
      const Pose command = tip(bench.model.mechanism, commanded.configuration);
      CHECK(deviation(answers[k].command, command).cwiseAbs().maxCoeff() <= answer_tolerance);
      CHECK(deviation(answers[k].X_MT, wanted).cwiseAbs().maxCoeff() <= answer_tolerance);
    }
  }
  CHECK(solved >= 20);  // of 24
}

TEST_CASE("batches: nominal tips and configurations are those of followed kinematics") {
  for (const BatchTrial& batch_trial : batch_trials()) {
    CAPTURE(batch_trial.trial.name);
    BatchBench bench(batch_trial.machine, batch_trial.at_platform);
    Random random(9);
    for (const BatchRequest& request : cluster(bench, batch_trial.trial, random, 3, 0.01)) {
      NominalAnswer answer;
      bench.solver.nominal_tips({&request.at, 1}, {&answer, 1});
      REQUIRE(answer.solved);
      const NominalResult nominal = follow(bench.model, bench.model.home, {bench.home().R, request.at.p});
      REQUIRE(nominal.status == Status::converged);
      CHECK(deviation(answer.X_MT, tip(bench.model.mechanism, nominal.configuration)).norm() <=
            answer_tolerance);
      NominalResult of_kernel;
      bench.solver.nominals({&request.at, 1}, {&of_kernel, 1});
      REQUIRE(of_kernel.status == Status::converged);
      CHECK(largest_difference(of_kernel.configuration, nominal.configuration) < 1e-9);
    }
  }
}

TEST_CASE("batches: a machine that does not control x, y and z is not solved") {
  for (const Machine& machine :
       {machine_of("bar_buckling"), machine_of("two_chains_coupled"), machine_of("arm")}) {
    CAPTURE(machine.name);
    BatchBench bench(machine);
    const BatchRequest at_home{{bench.home().p}, Vector6::Zero()};
    CHECK(!bench.solve(BatchQuestion::forward, whole, {at_home})[0].solved);
    CHECK(bench.solver.nominal_near(at_home.at) == nullptr);
    NominalResult none{Status::converged, {}};
    bench.solver.nominals({&at_home.at, 1}, {&none, 1});
    CHECK(none.status != Status::converged);
  }
}

TEST_CASE("batches: a place outside of travel, or out of reach, is not solved") {
  BatchBench mill(sample_machine("mill3/machine"));
  const Vector3 inside(0.2, 0.12, mill.home().p.z() - 0.1);
  const auto at_x = [&](double x) {
    return BatchRequest{{Vector3(x, inside.y(), inside.z())}, Vector6::Zero()};
  };
  const auto answers =
      mill.solve(BatchQuestion::forward, whole, {at_x(0.3999), at_x(0.4001), at_x(-0.0001), at_x(0.0001)});
  CHECK(answers[0].solved);
  CHECK(!answers[1].solved);
  CHECK(!answers[2].solved);
  CHECK(answers[3].solved);
  BatchBench orthoglide(machine_of("orthoglide_case_b"));
  for (const double x : {0.9, -0.9, 1e3})
    CHECK(
        !orthoglide.solve(BatchQuestion::forward, whole, {{{Vector3(x, 0, 0)}, Vector6::Zero()}})[0].solved);
}
