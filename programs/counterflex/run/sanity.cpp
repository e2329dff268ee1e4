#include "run/sanity.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "counterflex/geometry/types.hpp"
#include "counterflex/program/read_program.hpp"
#include "counterflex/sanity/checks.hpp"
#include "run/program_axes.hpp"
#include "run/work.hpp"

namespace counterflex::cli {
namespace {

void append(SanityChecks& checks, SanityChecks more) {
  checks.insert(checks.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

/// The frames used by moves of a program, each once.
std::vector<WorkFrame> frames_in_use(const PlacedProgram& placed) {
  std::vector<WorkFrame> frames;
  const std::vector<int>& lines = placed.program.frame_lines;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i] == 0) continue;
    const WorkFrame& frame = placed.work.frames[i];
    const bool known = std::any_of(frames.begin(), frames.end(), [&](const WorkFrame& other) {
      return other.name == frame.name && other.X_MW.R == frame.X_MW.R && other.X_MW.p == frame.X_MW.p;
    });
    if (!known) frames.push_back(frame);
  }
  return frames;
}

SanityCheck check_selected_offsets(const Overview& program, const Machine& machine) {
  bool gives_base = false, in_machine_frame = false;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < program.frame_lines.size(); ++i) {
    if (program.frame_lines[i] == 0) continue;
    const ProgramFrame& frame = program.frames[i];
    if (frame.pose_mm)
      gives_base = true;
    else if (is_placed_by_program(program, frame))
      in_machine_frame = true;
    else
      names.push_back(frame.work_offset);
  }
  if (names.empty() && in_machine_frame)
    return {"work offset", SanityState::ok,
            gives_base ? "the program gives its base: coordinates without one are machine coordinates"
                       : "the program does not select one: its coordinates are machine coordinates"};
  if (names.empty() && !gives_base)
    return {"work offset", SanityState::ok, "no move with a known position uses one"};
  return check_work_offset(names, !machine.work.empty() || machine.work_is_machine_frame);
}

/// The machine with [tool], if some move uses it, and with the tools that change it.
std::vector<const Model*> models_in_use(const PlacedProgram& placed) {
  std::vector<const Model*> models;
  const auto& numbers = placed.program.tools;
  const bool all_change = !numbers.empty() && std::all_of(numbers.begin(), numbers.end(), [&](long number) {
    return placed.tools.count(number) > 0;
  });
  if (!all_change) models.push_back(&placed.machine.model);
  for (const auto& [number, model] : placed.tools) models.push_back(&model);
  return models;
}

/// Whether all forces come from cutting models.
bool are_computed(const Run& run) {
  const auto& rules = run.force_input.source.rules;
  return !run.program.commented_force && std::all_of(rules.begin(), rules.end(), [](const ForceRule& rule) {
    return !std::holds_alternative<ConstantForce>(rule.content) &&
           !std::holds_alternative<ForceProfile>(rule.content);
  });
}

/// The place of the path with the largest deviation, which is known at the end of a run.
std::optional<SanityCheck> stiffness_on_path(const Run& run, const RunReport& report) {
  if (report.worst.empty()) return std::nullopt;
  const WorstRow& row = report.worst.front();
  const WorstPlace& place = report.after ? row.at_after : row.at_before;
  if (!place.known) return std::nullopt;
  const long tool =
      place.operation < 0 ? 0 : report.operations[static_cast<std::size_t>(place.operation)].tool;
  const Model& model = model_with(run.machine.model, &run.tool_models, tool);
  return check_tip_stiffness(tip_stiffness(model, place.place_mm * mm), fmt::format("at line {}", row.line));
}

}  // namespace

SanityChecks machine_sanity(const Machine& machine, const Model& model) {
  std::vector<WorkFrame> frames;
  for (const auto& [name, offset] : machine.work) frames.push_back({name, offset.X_MW});
  std::map<long, double> lengths_mm;
  for (const auto& [number, tool] : machine.tools)
    if (tool.length) lengths_mm[number] = *tool.length / mm;
  const bool turns = turns_joints(machine), inverted = machine.allows_inverted_tool;
  SanityCheck axis = check_tool_axis({&model}, frames, turns, inverted);
  const auto fits = [&](const WorkFrame& frame) {
    return check_tool_axis({&model}, {frame}, turns, inverted).state != SanityState::wrong;
  };
  if (axis.state == SanityState::wrong && std::any_of(frames.begin(), frames.end(), fits))
    axis.state = SanityState::doubtful;  // a program may use the other offsets
  SanityChecks checks{std::move(axis), check_tip_stiffness(tip_stiffness(model, {}), "at home"),
                      check_tool_lengths(lengths_mm, {}, machine.X_PS.has_value())};
  append(checks, check_magnitudes(machine));
  return checks;
}

SanityChecks program_sanity(const PlacedProgram& placed) {
  const Machine& machine = placed.machine.machine;
  const Model& model = placed.machine.model;
  SanityChecks checks{check_tool_axis(models_in_use(placed), frames_in_use(placed), turns_joints(machine),
                                      machine.allows_inverted_tool),
                      check_tip_stiffness(tip_stiffness(model, {}), "at home"),
                      check_tool_lengths(placed.lengths.mm, placed.program.tools, machine.X_PS.has_value()),
                      check_selected_offsets(placed.program, machine)};
  append(checks, check_program_axes(placed.program, machine));
  append(checks, check_magnitudes(machine));
  return checks;
}

void refuse_wrong(const SanityChecks& checks, const Machine& machine) {
  for (const SanityCheck& check : checks)
    if (check.state == SanityState::wrong)
      throw InputError(ErrorKind::machine_or_force, machine.tool_at, check.text);
}

SanityChecks run_sanity(const Run& run, const RunReport& report, const RunTally& tally) {
  SanityChecks checks = run.sanity;
  if (auto stiffness = stiffness_on_path(run, report)) {
    const auto home = std::find_if(checks.begin(), checks.end(),
                                   [](const SanityCheck& check) { return check.name == "tip stiffness"; });
    checks.insert(home + 1, std::move(*stiffness));
  }
  checks.push_back(check_travel(run.machine.model.mechanism, tally.travel(), report.failure));
  // A force that acts only in holes and in blocks that only turn the tool has no direction of feed.
  if (tally.feed_force().loaded > 0 || report.forces.largest_N == 0 || report.failure)
    checks.push_back(check_feed_force(tally.feed_force(), are_computed(run), report.failure));
  append(checks, check_force_size(report.forces.largest_N));
  append(checks, check_tolerance(report.tolerance_mm));
  return checks;
}

}  // namespace counterflex::cli
