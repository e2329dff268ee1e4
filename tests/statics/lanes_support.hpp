#pragma once
/// Waypoints solved in lanes, and each of them alone and cold, to compare.
#include "counterflex/statics/lanes.hpp"
#include "laws_support.hpp"

namespace counterflex::laws {

inline constexpr Stage whole, without_errors{.errors = 0}, without_weights{.gravity = 0};

/// A machine with its lanes. It stays where it is: lanes refer to the model.
struct LaneBench {
  Model model;
  bool at_platform;
  LaneMachine machine;
  LaneSolver lanes{machine};
  StaticsWork work{model.mechanism};

  explicit LaneBench(const Machine& m, bool platform = false, double reach = 5 * mm)
      : model(prepare(m)), at_platform(platform), machine(model, platform, reach) {}
  LaneBench(const LaneBench&) = delete;

  Pose home() const { return tip(model.mechanism, model.home); }

  std::vector<LaneAnswer> solve(LaneQuestion question, const Stage& stage,
                                const std::vector<LaneRequest>& requests) {
    std::vector<LaneAnswer> answers(requests.size());
    lanes.solve(question, stage, requests, answers);
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

/// A machine for lanes, and how far from home and how hard it is tried.
struct LaneTrial {
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

/// Every reference and sample machine that lanes can do. The kinematics of "laws_mixed" are no polynomials in
/// zones of their size: lanes leave it alone.
inline std::vector<LaneTrial> lane_trials() {
  std::vector<LaneTrial> list;
  for (const Trial& trial : controlled_machines())
    if (trial.name != "laws_mixed") list.push_back({trial, machine_of(trial.name)});
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
inline std::vector<LaneRequest> cluster(const LaneBench& bench, const Trial& trial, Random& random, int count,
                                        double extent, double strength = 1) {
  const Vector3 centre = bench.home().p + trial.centre + random.vector(trial.reach);
  std::vector<LaneRequest> requests;
  for (int i = 0; i < count; ++i)
    requests.push_back(
        {centre + random.vector(extent), random.six(strength * trial.force, strength * trial.moment)});
  return requests;
}

/// What lanes say is solved is what the machine does, to `tolerance` (m, rad).
inline void check_lane(LaneBench& bench, LaneQuestion question, const Stage& stage, const LaneRequest& request,
                       const LaneAnswer& answer, double tolerance) {
  const bool target = question == LaneQuestion::target;
  CAPTURE(target);
  CAPTURE(stage.errors);
  CAPTURE(stage.gravity);
  CAPTURE(request.p);
  CAPTURE(request.F);
  const Equilibrium alone = bench.alone(answer.command, request.F, stage);
  CAPTURE(to_string(alone.status));
  CHECK(alone.status == Status::converged);
  if (alone.status != Status::converged) return;
  const Vector6 miss = deviation(answer.X_MT, tip(bench.model.mechanism, alone.configuration));
  CHECK(miss.cwiseAbs().maxCoeff() <= tolerance);
  if (target)
    CHECK((answer.X_MT.p - request.p).norm() <= tolerance);
  else
    CHECK(answer.command == request.p);
}

}  // namespace counterflex::laws
