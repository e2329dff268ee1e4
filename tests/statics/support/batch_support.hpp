#pragma once
/// Waypoints solved in batches, and each of them alone and cold, to compare.
#include "counterflex/statics/batch_solver.hpp"
#include "statics/support/laws_support.hpp"

namespace counterflex::laws {

inline constexpr Stage whole, without_errors{.errors = 0}, without_weights{.gravity = 0};

/// A machine with its solver. It must not move: the table refers to the model.
struct BatchBench {
  Model model;
  bool at_platform;
  StartTable table;
  BatchSolver solver{table};
  StaticsWork work{model.mechanism};

  explicit BatchBench(const Machine& m, bool platform = false)
      : model(prepare(m)), at_platform(platform), table(model, platform) {}
  BatchBench(const BatchBench&) = delete;

  Pose home() const { return tip(model.mechanism, model.home); }

  std::vector<BatchAnswer> solve(BatchQuestion question, const Stage& stage,
                                 const std::vector<BatchRequest>& requests) {
    std::vector<BatchAnswer> answers(requests.size());
    solver.solve(question, stage, requests, answers);
    return answers;
  }

  /// The equilibrium at a commanded position, from home and from nothing.
  Equilibrium alone(const Vector3& command, const Vector6& F, const Stage& stage) {
    const NominalResult nominal = follow(model, model.home, {home().R, command});
    Equilibrium none;
    none.status = nominal.status;
    if (nominal.status != Status::converged) return none;
    none.status = Status::outside_travel;
    if (!within_travel(model.mechanism, actuator_values(model.mechanism, nominal.configuration))) return none;
    return solve_forward(model, nominal.configuration, {F, at_platform}, stage, work);
  }
};

/// A machine, and how far from home and how hard it is tried.
struct BatchTrial {
  Trial trial;
  Machine machine;
  bool at_platform = false;
};

inline Machine with_tip_at(Machine machine, const Vector3& p_PT) {
  machine.X_PT.p += p_PT;
  return machine;
}

inline Machine sample_machine(const std::string& name) {
  return load_machine(COUNTERFLEX_SOURCE_DIR "/samples/" + name + ".toml");
}

/// Every reference and sample machine whose tip is controlled in x, y and z.
inline std::vector<BatchTrial> batch_trials() {
  std::vector<BatchTrial> list;
  for (const Trial& trial : controlled_machines()) list.push_back({trial, machine_of(trial.name)});
  const auto add = [&](const Trial& trial, const Machine& machine, bool at_platform = false) {
    list.push_back({trial, machine, at_platform});
  };
  const Trial orthoglide = list[1].trial, hexapod = list[2].trial;
  add(orthoglide, machine_of("orthoglide_perfect"));
  add(orthoglide, with_tip_at(machine_of("orthoglide_case_b"), {0.01, -0.02, -0.1}));
  add(orthoglide, with_tip_at(machine_of("orthoglide_case_b"), {0.01, -0.02, -0.1}), true);
  add(hexapod, with_tip_at(machine_of("hexapod_free_joints"), {0.02, -0.03, 0.08}), true);
  add({"cantilever", 0.05, 0, 20, 2}, machine_of("cantilever"));
  add({"parallel_bars_group", 0.05, 0, 200, 10}, machine_of("parallel_bars_group"));
  add({"mill3", 0.05, 0, 500, 30, {0.2, 0.12, -0.1}}, sample_machine("mill3/machine"));
  add({"mill3-slot", 0.05, 0, 500, 30, {0.2, 0.12, -0.1}}, sample_machine("mill3-slot/machine"));
  add(orthoglide, sample_machine("orthoglide-groove/machine"));
  return list;
}

/// Waypoints beside each other about a random place, loads up to `strength` times the trial's.
inline std::vector<BatchRequest> cluster(const BatchBench& bench, const Trial& trial, Random& random,
                                         int count, double extent, double strength = 1) {
  const Vector3 centre = bench.home().p + trial.centre + random.vector(trial.reach);
  std::vector<BatchRequest> requests;
  for (int i = 0; i < count; ++i)
    requests.push_back(
        {{centre + random.vector(extent)}, random.six(strength * trial.force, strength * trial.moment)});
  return requests;
}

/// A solved answer is the equilibrium of the solver of single waypoints, to `tolerance` (m, rad).
inline void check_answer(BatchBench& bench, BatchQuestion question, const Stage& stage,
                         const BatchRequest& request, const BatchAnswer& answer, double tolerance) {
  const bool target = question == BatchQuestion::target;
  CAPTURE(target);
  CAPTURE(stage.errors);
  CAPTURE(stage.gravity);
  CAPTURE(request.at.p);
  CAPTURE(request.F);
  const Equilibrium alone = bench.alone(answer.command.p, request.F, stage);
  CAPTURE(to_string(alone.status));
  CHECK(alone.status == Status::converged);
  if (alone.status != Status::converged) return;
  const Vector6 miss = deviation(answer.X_MT, tip(bench.model.mechanism, alone.configuration));
  CHECK(miss.cwiseAbs().maxCoeff() <= tolerance);
  if (target)
    CHECK((answer.X_MT.p - request.at.p).norm() <= tolerance);
  else
    CHECK(answer.command.p == request.at.p);
}

}  // namespace counterflex::laws
