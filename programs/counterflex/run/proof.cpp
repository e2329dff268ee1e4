#include "run/proof.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/pose.hpp"
#include "counterflex/geometry/types.hpp"
#include "run/guard.hpp"

namespace counterflex::cli {
namespace {

std::vector<ProofFacts::Offset> offsets_of(const Run& run) {
  const Machine& machine = run.machine.machine;
  std::vector<ProofFacts::Offset> offsets;
  for (std::size_t i = 0; i < run.program.frame_lines.size(); ++i) {
    if (run.program.frame_lines[i] == 0) continue;
    const ProgramFrame& in_program = run.program.frames[i];
    const Pose X_MW = pose_of_offset(run.work.frames[i], in_program);
    ProofFacts::Offset offset{offset_name(run.program, in_program), X_MW.p / mm, to_rpy(X_MW.R) / deg, {}};
    if (machine.work_is_machine_frame) offset.work.clear();
    const auto known = machine.work.find(offset.work);
    if (known != machine.work.end() && known->second.shown && !is_set(in_program))
      offset.shown_mm = *known->second.shown / mm;
    const bool listed = std::ranges::any_of(offsets, [&](const ProofFacts::Offset& other) {
      return other.work == offset.work && (other.place_mm - offset.place_mm).norm() < 1e-6 &&
             (other.rpy_deg - offset.rpy_deg).norm() < 1e-9;
    });
    if (!listed) offsets.push_back(std::move(offset));
  }
  return offsets;
}

std::string constant_words(const ForceRule& rule) {
  const Vector6& F = std::get<ConstantForce>(rule.content).F;
  std::string text = fmt::format("constant {:g}, {:g}, {:g} N", F[0], F[1], F[2]);
  if (!F.tail<3>().isZero(0)) text += fmt::format(" and {:g}, {:g}, {:g} N m", F[3], F[4], F[5]);
  return text;
}

/// Whether a rule is for all moves, or for all moves of a tool: not for places or operations.
bool is_for_all_moves(const ForceRule& rule) {
  const ForceSelector& s = rule.selector;
  return !std::holds_alternative<ForceProfile>(rule.content) && !s.operation && !s.lines && !s.blocks;
}

/// Where the force on the moves of a tool comes from. A rule for the tool replaces those for all tools. Rules
/// of files that select moves by place or operation may act on any tool.
std::vector<std::string> forces_on(const Run& run, long tool) {
  const ForceSource& source = run.force_input.source;
  std::vector<std::string> words;
  const auto add = [&](std::string text) {
    if (std::ranges::find(words, text) == words.end()) words.push_back(std::move(text));
  };
  if (source.scale == 0) return words;
  const bool has_own = std::ranges::any_of(source.rules, [&](const ForceRule& rule) {
    return rule.selector.tool == tool && is_for_all_moves(rule);
  });
  for (const ForceRule& rule : source.rules) {
    if (rule.selector.tool.value_or(tool) != tool) continue;
    if (has_own && !rule.selector.tool && is_for_all_moves(rule)) continue;
    add(rule.where.file.empty() ? constant_words(rule)
                                : "file " + rule.where.file.substr(rule.where.file.find_last_of('/') + 1));
  }
  if (run.program.commented_force) add("comments (FORCE ...) of the program");
  if (source.scale != 1 && !words.empty()) words.back() += fmt::format(", times {:g}", source.scale);
  return words;
}

std::vector<ProofFacts::Tool> tools_of(const Run& run) {
  std::vector<ProofFacts::Tool> tools;
  for (const long number : run.program.tools) {
    ProofFacts::Tool tool{number, {}, {}, forces_on(run, number)};
    if (const auto length = run.tools.mm.find(number); length != run.tools.mm.end())
      tool.length_mm = length->second;
    const auto known = run.machine.machine.tools.find(number);
    if (known != run.machine.machine.tools.end() && known->second.diameter)
      tool.radius_mm = *known->second.diameter / 2 / mm;
    tools.push_back(std::move(tool));
  }
  return tools;
}

/// The smallest window of all tools whose lengths change the machine.
void add_window(const Run& run, const std::vector<LoadPlace>& places, ProofFacts& facts) {
  facts.window_places = places.size();
  facts.window_turns = is_robot_dialect(run.program.dialect);
  if (places.empty()) return;
  for (const auto& [number, model] : run.tool_models) {
    if (!run.tools.mm.contains(number)) continue;
    const std::optional<double> window = window_of(run, number, places);
    facts.window_mm = facts.window_lengths && window ? std::min(*facts.window_mm, *window) : window;
    facts.window_lengths = true;
    if (!window) return;
  }
  if (!facts.window_lengths) facts.window_mm = window_of(run, std::nullopt, places);
}

}  // namespace

bool wants_proof(const Options& options) {
  return options.proof && options.command != Command::predict;
}

void ProofNotes::add(const Job& window, const std::vector<Waypoint>& waypoints) {
  places_.add(window, waypoints);
  solved_ += static_cast<std::size_t>(
      std::ranges::count_if(waypoints, [](const Waypoint& w) { return w.status == Status::converged; }));
}

void ProofNotes::listen(WindowEvents& events) {
  events.solved = [this, then = std::move(events.solved)](const Job& window,
                                                          const std::vector<Waypoint>& waypoints) {
    then(window, waypoints);
    add(window, waypoints);
  };
}

ProofFacts ProofNotes::facts(const Run& run) {
  const std::vector<LoadPlace> places = places_.places();
  ProofFacts facts;
  facts.serial = run.machine.machine.serial;
  facts.date = run.machine.machine.date;
  facts.offsets = offsets_of(run);
  add_window(run, places, facts);
  facts.tools = tools_of(run);
  facts.restart = restart_.finish();
  facts.solved_places = solved_;
  return facts;
}

}  // namespace counterflex::cli
