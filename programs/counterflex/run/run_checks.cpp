#include "run/run_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <string>
#include <utility>

#include "counterflex/files/input_error.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/machine.hpp"
#include "counterflex/settings/project_file.hpp"
#include "counterflex/statics/nominal.hpp"
#include "run/reading.hpp"

namespace counterflex::cli {

/// A program that turns the tool needs a machine that can.
void refuse_orientation(const Run& run) {
  if (!run.program.turns_tool || controls_pose(run.machine.machine)) return;
  throw InputError(
      ErrorKind::machine_or_force, {shown_name(run.machine.file.path)},
      "the program gives the tool's orientation, but `controlled` does not list all of x, y, z, rx, "
      "ry, rz: take the file of a six-axis machine, or add what the machine controls");
}

/// Points of X, Y and Z are computed with the orientation at home.
void refuse_tool_axis(const Run& run) {
  constexpr double equal_deg = 0.1;  // so small a turn of the arm changes the correction by next to nothing
  const Model& model = run.machine.model;
  const Vector3 at_home = tip(model.mechanism, model.home).R.col(2);
  for (std::size_t i = 0; i < run.program.frames.size(); ++i) {
    const auto& axis = run.program.frames[i].tool_axis;
    if (!axis || run.program.frame_lines[i] == 0) continue;
    const Vector3 stated = run.work.frames[i].X_MW.R * *axis;
    const double angle_deg = std::atan2(stated.cross(at_home).norm(), stated.dot(at_home)) / deg;
    if (angle_deg <= equal_deg) continue;
    throw InputError(
        ErrorKind::machine_or_force, {run.program.file, run.program.frame_lines[i]},
        fmt::format(
            "TLAXIS/{:.6g},{:.6g},{:.6g} states the tool axis for points of three numbers, {:.2f} deg "
            "from the axis of the machine at home; at most {} deg is allowed: post each point with "
            "its axis (GOTO/ with six numbers), or take a machine file whose home has this axis",
            axis->x(), axis->y(), axis->z(), angle_deg, equal_deg));
  }
}

void refuse_what_cannot_be_compensated(const Run& run) {
  if (run.machine.machine.controlled.empty())
    throw InputError(ErrorKind::machine_or_force, {shown_name(run.machine.file.path)},
                     "controlled = [] allows analyze and predict only; list the components of the tip that "
                     "the program controls");
  if (run.is_corrected)
    throw InputError(
        ErrorKind::program_text, {run.program.file, 1, 1},
        "the program has the header of a corrected program (COUNTERFLEX 1); a program is not compensated "
        "twice");
}

namespace {

/// Warns of orientations that the machine controls but a program of X, Y and Z does not state.
void warn_of_orientation(Run& run) {
  const Machine& machine = run.machine.machine;
  const auto& lines = run.program.frame_lines;
  const bool has_places = std::ranges::any_of(lines, [](int line) { return line > 0; });
  if (!has_places || run.program.turns_tool ||
      std::none_of(machine.controlled.begin(), machine.controlled.end(),
                   [](Component c) { return c > Component::z; }))
    return;
  run.facts.warnings.push_back(
      {0,
       "the machine controls the tool's orientation, but the program does not state it: the orientation at "
       "home is used and its error is not corrected (see the largest rotation)"});
}

/// Warns of tools without stiffness, and of tools that are missing in a file with other tools.
void warn_of_tools(Run& run) {
  const Machine& machine = run.machine.machine;
  const auto& tools = machine.tools;
  const bool bends =
      std::any_of(tools.begin(), tools.end(), [](const auto& t) { return !t.second.yields.empty(); });
  if (run.tool_models.empty() && !bends) return;
  if (run.program.first_cut_without_tool)
    run.facts.warnings.push_back(
        {*run.program.first_cut_without_tool,
         "no tool is selected here (T with M6): [tool] is used, rigid, and [tools] is not used"});
  for (const long number : run.program.tools) {
    if (number == 0) continue;
    const auto found = tools.find(number);
    const Tool* tool = found == tools.end() ? nullptr : &found->second;
    std::string what;
    if (tool == nullptr)
      what = " is not in [tools]: its moves use [tool], rigid";
    else if (!tool->in_file && bends)
      what = " is not in [tools] of the machine file: it is " + stiffness_phrase(*tool);
    else if (tool->from == ToolStiffness::cantilever)
      what = ": " + stiffness_phrase(*tool);
    if (!what.empty()) run.facts.warnings.push_back({0, fmt::format("tool T{}{}", number, what)});
  }
}

/// Compensation refuses it.
void warn_of_corrected(Run& run, Command command) {
  if (!run.is_corrected || command == Command::compensate) return;
  run.facts.warnings.push_back({1,
                                "the program is a corrected one (COUNTERFLEX 1): its lines are not those of "
                                "the original, so forces that "
                                "are given by line act elsewhere"});
}

/// Warns of work offsets without a datum. They count as "machine".
void warn_of_datum(Run& run) {
  std::set<std::string> warnings;  // one offset may have several frames
  for (const WorkFrame& frame : run.work.frames) {
    if (!frame.common_shift || frame.common_shift->norm() <= run.options.tolerance) continue;
    const Vector3 shift_mm = *frame.common_shift / mm;
    const std::string assumed = frame.name.empty()
                                    ? "no datum is stated: the machine frame counts"
                                    : fmt::format("no datum is stated for {}: it counts", frame.name);
    const std::string cure =
        frame.name.empty()
            ? "give the work offset with its datum, or --work machine"
            : fmt::format(
                  "state datum = {{ touched_at_mm = [x, y, z] }} in [work.{0}], else datum = \"machine\"",
                  toml_key(frame.name));
    const std::string warning = fmt::format(
        "{} as set independently of this machine's errors. The unloaded machine is off by "
        "({}, {}, {}) mm on average along the path, and the correction removes this. If the "
        "part was touched off with this machine, the offset contains this shift already: {}",
        assumed, format_fixed(shift_mm.x(), 4), format_fixed(shift_mm.y(), 4), format_fixed(shift_mm.z(), 4),
        cure);
    if (warnings.insert(warning).second) run.facts.warnings.push_back({0, warning});
  }
}

}  // namespace

void add_input_warnings(Run& run, Command command) {
  warn_of_corrected(run, command);
  warn_of_datum(run);
  warn_of_orientation(run);
  warn_of_tools(run);
  if (auto cycles = remark_of_cycles(run.program, run.force_input.source, command))
    run.facts.warnings.push_back(std::move(*cycles));
  std::ranges::copy(run.work.assumptions, std::back_inserter(run.facts.warnings));
}

}  // namespace counterflex::cli
