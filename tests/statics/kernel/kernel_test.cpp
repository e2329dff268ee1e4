/// The kernel beside the solver of single waypoints.
#include <cmath>
#include <filesystem>

#include "counterflex/geometry/pose.hpp"
#include "statics/support/kernel_support.hpp"
#include "statics/support/laws_tables.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

struct KernelTrial {
  Trial trial;
  Model model;
};

std::vector<KernelTrial> kernel_trials() {
  std::vector<KernelTrial> list;
  for (const Trial& trial : controlled_machines()) list.push_back({trial, model_of(trial.name)});
  for (const Trial& trial : controlled_machines()) {
    list.push_back({trial, prepare(heavy(machine_of(trial.name), 0.5))});
    list.back().trial.name += ", with masses everywhere";
  }
  for (const Trial& trial : controlled_machines()) {
    list.push_back({trial, prepare(with_tables(heavy(machine_of(trial.name), 0.5), 0.3))});
    list.back().trial.name += ", with tables of errors and masses";
  }
  return list;
}

std::vector<KernelWaypoint> waypoints_of(const FlatBench& bench, const Trial& trial, int count,
                                         unsigned seed) {
  Random random(seed);
  std::vector<KernelWaypoint> list;
  for (int i = 0; i < count; ++i) {
    const NominalResult nominal = somewhere(bench.model, trial, random);
    list.push_back(bench.waypoint(nominal, random.six(trial.force, trial.moment)));
  }
  return list;
}

/// The same waypoints with the actuators of the answers, held.
std::vector<KernelWaypoint> with_actuators(std::vector<KernelWaypoint> waypoints,
                                           const KernelAnswers& answers) {
  for (std::size_t w = 0; w < waypoints.size(); ++w) waypoints[w].rho = answers.rho(w);
  return waypoints;
}

}  // namespace

TEST_CASE("kernel: nominal kinematics from home has the actuators of single waypoints") {
  for (KernelTrial& of : kernel_trials()) {
    CAPTURE(of.trial.name);
    FlatBench bench(of.model);
    REQUIRE(bench.flat.is_solvable);
    auto waypoints = waypoints_of(bench, of.trial, 8, 3);
    const auto home = kernel::state_of(bench.model.mechanism, bench.rigid, bench.model.home, 0);
    for (KernelWaypoint& w : waypoints) w.nominal_start = home;
    const KernelAnswers answers = bench.solve(bench.kinematics(), waypoints);
    for (std::size_t w = 0; w < waypoints.size(); ++w) {
      CAPTURE(answers.batch.iterations[w]);
      CHECK(answers.accepted(w));
      const auto rho = actuator_values(bench.model.mechanism, waypoints[w].nominal);
      CHECK((answers.rho(w) - rho).cwiseAbs().maxCoeff() < 1e-10);
    }
  }
}

TEST_CASE("kernel: targets and forward solutions are those of single waypoints") {
  for (KernelTrial& of : kernel_trials()) {
    CAPTURE(of.trial.name);
    FlatBench bench(of.model);
    const auto waypoints = waypoints_of(bench, of.trial, 8, 4);
    const KernelAnswers targets = bench.solve(bench.target(), waypoints);
    const KernelAnswers forward = bench.solve(bench.held(), waypoints);
    for (std::size_t w = 0; w < waypoints.size(); ++w) {
      CAPTURE(w);
      CAPTURE(targets.batch.iterations[w]);
      CAPTURE(forward.batch.iterations[w]);
      const Load load{waypoints[w].F, false};
      const Equilibrium target =
          solve_target(bench.model, waypoints[w].nominal, waypoints[w].X_MT, load, {}, bench.work);
      const Equilibrium alone = solve_forward(bench.model, waypoints[w].nominal, load, {}, bench.work);
      REQUIRE(target.status == Status::converged);
      REQUIRE(alone.status == Status::converged);
      CHECK(targets.accepted(w));
      CHECK(forward.accepted(w));
      CHECK(targets.negative_pivots(w) == 0);
      CHECK(forward.negative_pivots(w) == 0);
      CHECK((targets.rho(w) - actuator_values(bench.model.mechanism, target.configuration))
                .cwiseAbs()
                .maxCoeff() < 1e-10);
      CHECK(
          deviation(targets.tip(w), tip(bench.model.mechanism, target.configuration)).cwiseAbs().maxCoeff() <
          1e-10);
      CHECK(deviation(forward.tip(w), tip(bench.model.mechanism, alone.configuration)).cwiseAbs().maxCoeff() <
            1e-10);
      const NominalResult command = nominal_forward(bench.model, waypoints[w].nominal, targets.rho(w));
      CHECK(deviation(targets.nominal_tip(w), tip(bench.model.mechanism, command.configuration)).norm() <
            1e-10);
    }
  }
}

TEST_CASE(
    "kernel: components that are wanted of the command are those of the nominal tip, the others the real "
    "tip's") {
  for (KernelTrial& of : kernel_trials()) {
    CAPTURE(of.trial.name);
    FlatBench bench(of.model);
    const auto waypoints = waypoints_of(bench, of.trial, 4, 9);
    const auto& controlled = bench.flat.machine.controlled;
    for (const unsigned commanded : {0U, 56U, 63U, 5U}) {  // none, orientations, all, x and z
      CAPTURE(commanded);
      kernel::Problem problem = bench.target();
      for (std::size_t j = 0; j < 6; ++j) problem.of_command[j] = (commanded >> j & 1U) != 0;
      const KernelAnswers answers = bench.solve(problem, waypoints);
      const KernelAnswers held = bench.solve(bench.held(), with_actuators(waypoints, answers));
      for (std::size_t w = 0; w < waypoints.size(); ++w) {
        CHECK(answers.accepted(w));
        const Vector6 of_command = deviation(answers.nominal_tip(w), waypoints[w].X_MT),
                      of_tip = deviation(answers.tip(w), waypoints[w].X_MT);
        for (Eigen::Index j = 0; j < 6; ++j)
          if (controlled[static_cast<std::size_t>(j)])
            CHECK(std::abs(problem.of_command[static_cast<std::size_t>(j)] ? of_command[j] : of_tip[j]) <
                  1e-10);
        CHECK(deviation(held.tip(w), answers.tip(w)).norm() < 1e-10);
      }
    }
  }
}

TEST_CASE("kernel: an answer has the same bits in every instance, beside any neighbours, behind any solve") {
  for (KernelTrial& of : kernel_trials()) {
    CAPTURE(of.trial.name);
    FlatBench bench(of.model);
    const auto waypoints = waypoints_of(bench, of.trial, 11, 5);
    std::vector<KernelWaypoint> turned(waypoints.rbegin(), waypoints.rend());
    turned.resize(7);
    kernel::Solver solver;  // of all problems: each begins in memory that others have used
    for (const kernel::Problem& problem : {bench.target(), bench.held()}) {
      const KernelAnswers scalar = bench.solve(problem, waypoints);
      for (const kernel::Instance& instance : kernel::all_instances()) {
        CAPTURE(instance.lanes);
        const KernelAnswers answers = bench.solve(problem, waypoints, instance, {}, &solver);
        CHECK(answers.batch.tip == scalar.batch.tip);
        CHECK(answers.batch.actuators == scalar.batch.actuators);
        CHECK(answers.batch.state == scalar.batch.state);
        CHECK(answers.batch.accepted == scalar.batch.accepted);
        CHECK(answers.batch.pivots == scalar.batch.pivots);
        const KernelAnswers others = bench.solve(problem, turned, instance, {}, &solver);
        for (std::size_t w = 0; w < turned.size(); ++w)
          for (std::size_t i = 0; i < 12; ++i)
            CHECK(others.batch.tip[12 * w + i] == scalar.batch.tip[12 * (10 - w) + i]);
      }
    }
  }
}

TEST_CASE(
    "kernel: negative pivots at an equilibrium are there where the least eigenvalue of single waypoints is "
    "negative") {
  int unstable = 0, judged = 0;
  for (KernelTrial& of : kernel_trials()) {
    CAPTURE(of.trial.name);
    FlatBench bench(of.model);
    if (bench.flat.machine.has_hanging_weights) continue;
    Random random(6);
    for (const double strength : {1., 30., 300., 3000.}) {
      for (int i = 0; i < 6; ++i) {
        const NominalResult nominal = somewhere(bench.model, of.trial, random);
        const Load load{random.six(strength * of.trial.force, strength * of.trial.moment), false};
        const Equilibrium e = refine_forward(bench.model, nominal.configuration, load, {}, bench.work);
        if (e.status != Status::converged && e.status != Status::unstable) continue;
        KernelWaypoint waypoint = bench.waypoint(nominal, load.F);
        waypoint.start = kernel::state_of(bench.model.mechanism, bench.flat, e.configuration, 1);
        const KernelAnswers answer = bench.solve(bench.held(), {waypoint}, kernel::scalar_instance,
                                                 {.first = kernel::FirstStress::of_elements});
        if (!answer.accepted(0) ||
            deviation(answer.tip(0), tip(bench.model.mechanism, e.configuration)).norm() > 1e-9)
          continue;
        const double least = stability(bench.model, e.configuration, load, {}, bench.work);
        CAPTURE(strength);
        CAPTURE(least);
        CHECK((answer.negative_pivots(0) > 0) == (least < 0));
        unstable += least < 0;
        ++judged;
      }
    }
  }
  CHECK(judged > 60);
  CHECK(unstable > 5);
}

TEST_CASE("kernel: what it accepts at home of any machine is the equilibrium of single waypoints") {
  int accepted = 0;
  for (const auto& file : std::filesystem::directory_iterator(COUNTERFLEX_SOURCE_DIR "/tests/statics/data")) {
    if (file.path().extension() != ".toml") continue;
    const std::string name = file.path().stem().string();
    CAPTURE(name);
    FlatBench bench(model_of(name));
    if (!bench.flat.is_solvable) continue;
    Random random(7);
    for (int i = 0; i < 4; ++i) {
      const NominalResult home{Status::converged, bench.model.home};
      const Load load{random.six(20, 2), false};
      const Equilibrium alone = solve_forward(bench.model, bench.model.home, load, {}, bench.work);
      const KernelAnswers answer = bench.solve(bench.held(), {bench.waypoint(home, load.F)});
      if (!answer.accepted(0)) continue;
      ++accepted;
      if (alone.status == Status::unstable) {
        CHECK(answer.negative_pivots(0) > 0);
        continue;
      }
      CHECK(alone.status == Status::converged);
      CHECK(deviation(answer.tip(0), tip(bench.model.mechanism, alone.configuration)).cwiseAbs().maxCoeff() <
            1e-10);
      if (!bench.flat.machine.has_hanging_weights) CHECK(answer.negative_pivots(0) == 0);
    }
  }
  CHECK(accepted >= 76);
}

namespace {

struct CellPair {
  kernel::StartCell kinematics, target;
};

CellPair cells_at(const FlatBench& bench, const Vector3& centre, double step) {
  const Matrix3 R_home = tip(bench.model.mechanism, bench.model.home).R;
  const NominalResult nominal = follow(bench.model, bench.model.home, {R_home, centre});
  REQUIRE(nominal.status == Status::converged);
  const bool turns = bench.model.mechanism.controlled.size() > 3;
  const kernel::CellPlace place{R_home, turns, centre, step};
  const KernelWaypoint start = bench.waypoint(nominal, Vector6::Zero());
  auto kinematics = kernel::make_kinematics_cell(bench.nominal(), place, start.nominal_start);
  REQUIRE(kinematics);
  auto target = kernel::make_target_cell(bench.question(), bench.nominal(), place, start.start, *kinematics);
  REQUIRE(target);
  return {std::move(*kinematics), std::move(*target)};
}

}  // namespace

TEST_CASE("kernel: cells give starts, and no answer depends on the cell") {
  for (KernelTrial& of : kernel_trials()) {
    if (of.trial.name.starts_with("laws_mixed")) continue;
    CAPTURE(of.trial.name);
    FlatBench bench(of.model);
    const double edge = bench.flat.machine.length / 24;
    const Pose home = tip(bench.model.mechanism, bench.model.home);
    kernel::Problem forward = bench.target();
    forward.of_command.fill(true);
    const kernel::Schedule schedule{.tangents = 1U | ~0U << 6, .first = kernel::FirstStress::of_cells};
    Random random(8);
    for (int i = 0; i < 6; ++i) {
      // A place on the face between two cells.
      const Vector3 centre = home.p + of.trial.centre + random.vector(0.8 * of.trial.reach);
      const Vector3 face = centre + edge * Vector3(0.5, 0.5 * random.number(), 0.5 * random.number());
      const NominalResult nominal = follow(bench.model, bench.model.home, {home.R, face});
      REQUIRE(nominal.status == Status::converged);
      const KernelWaypoint exact = bench.waypoint(nominal, random.six(of.trial.force, of.trial.moment));
      const CellPair here = cells_at(bench, centre, edge / 2),
                     beside = cells_at(bench, centre + edge * Vector3::UnitX(), edge / 2);
      KernelWaypoint from_here = exact, from_beside = exact;
      from_here.cell = &here.target, from_here.nominal_cell = &here.kinematics;
      from_beside.cell = &beside.target, from_beside.nominal_cell = &beside.kinematics;
      for (const kernel::Problem& problem : {bench.kinematics(), bench.target(), forward}) {
        const KernelAnswers alone = bench.solve(problem, {exact});
        for (const kernel::Instance& instance : kernel::all_instances()) {
          const KernelAnswers answers =
              bench.solve(problem, {from_here, from_beside, from_here}, instance, schedule);
          for (std::size_t w = 0; w < 3; ++w) {
            REQUIRE(answers.accepted(w));
            CHECK((answers.rho(w) - alone.rho(0)).cwiseAbs().maxCoeff() < 1e-11);
            CHECK(deviation(answers.nominal_tip(w), alone.nominal_tip(0)).cwiseAbs().maxCoeff() < 1e-11);
            if (problem.real) CHECK(deviation(answers.tip(w), alone.tip(0)).cwiseAbs().maxCoeff() < 1e-11);
            CHECK(answers.batch.iterations[w] <= (problem.real ? 10 : 2));
          }
          CHECK(answers.rho(0) == answers.rho(2));
        }
      }
    }
  }
}

TEST_CASE("kernel: a cell predicts the command of a tip that is moved, turned and loaded a little") {
  for (KernelTrial& of : kernel_trials()) {
    if (!std::isinf(of.model.mechanism.error_spacing)) continue;  // tables are no polynomials
    CAPTURE(of.trial.name);
    FlatBench bench(of.model);
    const double step = bench.flat.machine.length / 48;
    const Pose home = tip(bench.model.mechanism, bench.model.home);
    const CellPair cells = cells_at(bench, home.p + of.trial.centre, step);
    Random random(10);
    for (int i = 0; i < 4; ++i) {
      const Vector3 p = home.p + of.trial.centre + random.vector(0.1 * step);
      const Vector3 turn = cells.target.variables.turns ? random.vector(1e-3) : Vector3(Vector3::Zero());
      const Vector6 F = random.six(0.1 * of.trial.force, 0.1 * of.trial.moment);
      const Pose X_MT{exp_so3(turn) * home.R, p};
      const NominalResult nominal = follow(bench.model, bench.model.home, X_MT);
      REQUIRE(nominal.status == Status::converged);
      const KernelAnswers answers = bench.solve(bench.target(), {bench.waypoint(nominal, F)});
      REQUIRE(answers.accepted(0));
      const Vector6 offset = kernel::command_offset(cells.target, answers.tip(0).p, turn, F);
      const Vector6 at_centre =
          kernel::command_offset(cells.target, home.p + of.trial.centre, Vector3::Zero(), Vector6::Zero());
      Vector6 found;
      found << answers.nominal_tip(0).p - answers.tip(0).p,
          log_so3(Matrix3(answers.nominal_tip(0).R * answers.tip(0).R.transpose()));
      if (!cells.target.variables.turns) found.tail<3>() = offset.tail<3>();
      CHECK((found - offset).norm() < 0.02 * (found - at_centre).norm() + 1e-9);
    }
  }
}

TEST_CASE("kernel: under the force of a cut one step from a cell does on the Orthoglide, nearly always") {
  const KernelTrial of = kernel_trials()[1];
  FlatBench bench(of.model);
  const double step = bench.flat.machine.length / 48;
  const Pose home = tip(bench.model.mechanism, bench.model.home);
  const CellPair cells = cells_at(bench, home.p + of.trial.centre, step);
  Random random(12);
  constexpr int count = 50;
  int steps = 0;
  for (int i = 0; i < count; ++i) {
    const NominalResult nominal =
        follow(bench.model, bench.model.home, {home.R, home.p + of.trial.centre + random.vector(step)});
    REQUIRE(nominal.status == Status::converged);
    KernelWaypoint waypoint = bench.waypoint(nominal, random.six(100, 0));
    waypoint.cell = &cells.target, waypoint.nominal_cell = &cells.kinematics;
    const KernelAnswers answers =
        bench.solve(bench.target(), {waypoint}, kernel::scalar_instance, kernel::cell_schedule);
    REQUIRE(answers.accepted(0));
    steps += answers.batch.iterations[0];
  }
  CHECK(steps < 1.2 * count);  // 1.8 without products of a load and two positions, and stress of first order
}

TEST_CASE("kernel: a chain with more actuators than it has room for is refused") {
  std::string chain = "[[chain]]\nname = \"axes\"\nelements = [\n";
  for (int i = 0; i < 13; ++i)
    chain += "  { actuator = \"prismatic\", axis = \"x\", min_mm = -1, max_mm = 1 },\n";
  const Model model = model_of_text(chain + "]\n");
  CHECK_FALSE(kernel::flatten(model.mechanism, false).is_solvable);
}
