#pragma once
/// A small run with known numbers and made-up waypoints: three feed moves and a rapid.
#include "counterflex/geometry/types.hpp"
#include "counterflex/program/read_program.hpp"
#include "counterflex/report/run_tally.hpp"

namespace counterflex::test {

inline const char* const made_up_program =
    "(made up)\n"
    "G21 G90 G0 X0 Y0 Z5\n"
    "G0 Z0\n"
    "G1 X100 F600\n"
    "Y50\n"
    "X90 Z-5\n"
    "M30\n";

/// Owns everything that a Job refers to.
struct MadeUpRun {
  Machine machine;
  Model model;
  Program program = read_program(made_up_program, "made_up.ngc", {});
  Toolpath path = build_toolpath(program, one_frame(program, {}));
  ForceSource source = [] {
    ForceSource s;
    s.rules = {{"--force", {}, {}, ConstantForce{(Vector6() << 30, -40, 0, 0, 0, 2).finished()}}};
    return s;
  }();
  PathForces forces{source, program, path, {Matrix3::Identity()}};
  Job job{model, program, path, forces, {}, {}};
  RunFacts facts;

  MadeUpRun() {
    machine.name = "Mill";
    facts.version = "0.1.0";
    facts.inputs = {{"program", "made_up.ngc", std::string(64, 'a')},
                    {"machine", "mill.toml", std::string(64, 'b')}};
    facts.options = {{"tolerance-mm", 0.005}, {"method", std::string("direct")}, {"json", false}};
    facts.attribution = true;
  }
  MadeUpRun(const MadeUpRun&) = delete;

  RunContext context(const Overview& overview) const {
    return {machine, job.options, path.frames, overview, facts};
  }

  /// With the forces, and `waypoints` all at once.
  RunTally tally(std::vector<Waypoint> waypoints) const {
    for (Waypoint& w : waypoints)
      if (w.segment < path.segments.size())
        w.move = static_cast<std::uint32_t>(path.segments[w.segment].move);
    RunTally result(facts.min_block_ms);
    result.add_window(job);
    result.add_waypoints(waypoints, job);
    return result;
  }

  /// Replaces the program and its path.
  void read(const std::string& text, const char* file) {
    program = read_program(text, file, job.read);
    path = build_toolpath(program, one_frame(program, {}));
  }
};

/// What the waypoints' feed moves become where 30 % more or less force adds or takes 30 % of the load's
/// deviation. `status`: of the first one under more force.
inline void add_made_up_sensitivity(RunReport& report, const std::vector<Waypoint>& waypoints,
                                    Status status = Status::converged) {
  std::vector<LoadPlace> places;
  std::vector<OtherForce> higher, lower;
  for (const Waypoint& w : waypoints) {
    if (!w.cutting) continue;
    const Vector6 change = w.causes ? Vector6(force_change * w.causes->load) : Vector6(Vector6::Zero());
    places.push_back({.number = places.size(), .at = w});
    higher.push_back({w.after + change});
    lower.push_back({w.after - change});
  }
  if (!higher.empty()) higher.front().status = status;
  add_sensitivity(report, places, higher, lower);
}

/// The reports of runs of one window.
inline RunReport predicted(const MadeUpRun& run, const std::vector<Waypoint>& waypoints,
                           const std::optional<Failure>& failure = {}) {
  const Overview overview = overview_of(run.program);
  RunReport report = report_prediction(run.context(overview), run.tally(waypoints), failure);
  add_made_up_sensitivity(report, waypoints);
  return report;
}

inline RunReport compensated(const MadeUpRun& run, const Compensation& compensation) {
  const Overview overview = overview_of(run.program);
  RunTally tally = run.tally(compensation.waypoints);
  tally.add_compensation(compensation);
  ReadOptions read;
  read.dialect = run.program.dialect;
  if (!compensation.text.empty())
    tally.add_corrected(read_program(compensation.text, "made_up.comp.ngc", read));
  RunReport report = report_compensation(run.context(overview), tally, compensation.failure);
  add_made_up_sensitivity(report, compensation.waypoints);
  return report;
}

inline RunReport verified(const MadeUpRun& run, const Program& corrected,
                          const std::vector<Waypoint>& waypoints) {
  const Overview overview = overview_of(run.program);
  RunTally tally = run.tally(waypoints);
  tally.add_corrected(corrected);
  RunReport report = report_verification(run.context(overview), tally, overview_of(corrected), {});
  add_made_up_sensitivity(report, waypoints);
  return report;
}

/// A waypoint of a feed move with a position deviation before (mm), a hundredth of it after.
inline Waypoint cut(std::size_t segment, int line, double weight_mm, const Vector3& before_mm) {
  Waypoint w;
  w.segment = segment;
  w.line = line;
  w.cutting = true;
  w.weight = weight_mm * mm;
  w.direction = Vector3::UnitX();
  w.wrench << 30, -40, 0, 0, 0, 2;
  w.before.head<3>() = before_mm * mm;
  w.after = w.before / 100;
  w.causes.emplace();
  w.causes->geometry = w.before / 4;
  w.causes->load = w.before / 2;
  w.causes->superposition = w.causes->geometry + w.causes->load;
  w.causes->air = -w.causes->load;
  w.correction = -w.before;
  w.iterations = 7;
  return w;
}

/// Before: 0.3 mm on 100 mm, 0.5 mm on 50 mm, nothing on the rest.
inline std::vector<Waypoint> made_up_waypoints() {
  std::vector<Waypoint> list = {cut(1, 4, 75, Vector3(0, 0.3, 0)), cut(1, 4, 25, Vector3(0, 0.3, 0)),
                                cut(2, 5, 50, Vector3(0.3, 0, -0.4)), cut(3, 6, 10, Vector3::Zero())};
  list[0].place = false;
  list[0].between = true;  // only `after` is known there, and it is the worst
  list[0].before.setConstant(1);
  list[0].after.head<3>() = Vector3(0, 0, 0.006) * mm;
  Waypoint rapid = cut(0, 3, 0, Vector3(9, 9, 9));
  rapid.cutting = false;
  rapid.p_MT = Vector3(0, 0, 5) * mm;  // not where the feed move starts
  list.insert(list.begin(), rapid);
  return list;
}

/// A compensation with one waypoint, an inserted block and a block that is left alone.
inline Compensation small_compensation() {
  Compensation c;
  c.text = "G21 G0 X1\n";
  c.waypoints = {cut(1, 4, 100, Vector3(0, 0.3, -0.4))};
  c.waypoints[0].s = 100 * mm;
  c.waypoints[0].p_MT = Vector3(1, 2, 3) * mm;
  c.left_alone = {{5, "exact stop: not split"}};
  c.counts.inserted_blocks = 2;
  c.corrected_moves = 3;
  c.other_moves = {.grouped = 1, .held = 1};
  return c;
}

}  // namespace counterflex::test
