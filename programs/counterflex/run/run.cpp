#include "run/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <string>
#include <utility>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/machine.hpp"
#include "counterflex/program/size_limit.hpp"
#include "run/facts.hpp"
#include "run/header/header.hpp"
#include "run/program_axes.hpp"
#include "run/reading.hpp"
#include "run/run_checks.hpp"
#include "run/sanity.hpp"
#include "run/significance.hpp"
#include "run/uncertainty.hpp"

namespace counterflex::cli {
namespace {

/// Axes of the program that the machine does not control.
std::array<bool, 3> uncontrolled_axes(const Machine& machine, const std::vector<WorkFrame>& frames) {
  std::array<bool, 3> axes{};
  if (machine.controlled.empty()) return axes;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    bool moves_controlled = false;
    for (const WorkFrame& frame : frames)
      for (int c = 0; c < 3; ++c)
        moves_controlled = moves_controlled || (controls(machine, static_cast<Component>(c)) &&
                                                std::abs(frame.X_MW.R(c, axis)) > 1e-12);
    axes[static_cast<std::size_t>(axis)] = !moves_controlled;
  }
  return axes;
}

CompensationOptions compensation_options(const Options& options, const Machine& machine) {
  CompensationOptions result;
  result.method = options.method;
  result.tolerance = options.tolerance;
  result.tilt_tolerance = options.tilt_tolerance;
  result.spin_tolerance = options.spin_tolerance;
  result.max_correction = options.max_correction.value_or(machine.max_correction);
  result.blend = options.blend;
  result.only_significant = options.only_significant;
  result.threads = options.threads;
  result.write.decimals = options.decimals;
  return result;
}

/// The diameter of a tool: from [tools], else of the largest cutter whose forces may act on it.
std::vector<ToolSize> tool_sizes(const Run& run) {
  std::vector<ToolSize> sizes;
  for (const long number : run.program.tools) {
    ToolSize& size = sizes.emplace_back(ToolSize{number, {}, {}});
    const auto found = run.machine.machine.tools.find(number);
    if (found != run.machine.machine.tools.end()) {
      size.diameter = found->second.diameter;
      size.flute = found->second.flute;
    }
    if (size.diameter) continue;
    for (const ForceRule& rule : run.force_input.source.rules) {
      const auto* cut = std::get_if<CutResponse>(&rule.content);
      if (cut == nullptr || rule.selector.tool.value_or(number) != number) continue;
      size.diameter = std::max(size.diameter.value_or(0), cut->diameter);
    }
  }
  return sizes;
}

}  // namespace

RunInput Run::input() const {
  return {machine.model,
          work.frames,
          ignored,
          force_input.source,
          options,
          read,
          &tool_models,
          starts ? &*starts : nullptr,
          first_directions,
          uncertainties.empty() ? nullptr : &uncertainties,
          spins.empty() ? nullptr : &spins,
          as_programmed.empty() ? nullptr : &as_programmed};
}

RunContext Run::context() const {
  return {machine.machine, options, work.frames, program, facts};
}

void refuse_stdin_twice(const Options& options) {
  std::vector<std::string> paths{options.program, options.verify.corrected, options.machine,
                                 options.tool_table.value_or("")};
  paths.insert(paths.end(), options.forces.begin(), options.forces.end());
  paths.insert(paths.end(), options.data_lists.begin(), options.data_lists.end());
  paths.insert(paths.end(), options.compare.reports.begin(), options.compare.reports.end());
  paths.insert(paths.end(), options.identify.data.begin(), options.identify.data.end());
  paths.insert(paths.end(), {options.identify.program, options.identify.prior});
  const auto count = std::count(paths.begin(), paths.end(), "-");
  if (count > 1) throw InputError(ErrorKind::usage, {}, "standard input (-) can be only one of the inputs");
}

namespace {

std::unique_ptr<Run> prepared_run(const Options& options, MachineInput machine, Console& console,
                                  const std::function<ProgramFile()>& open) {
  ToolLengths tools = read_tool_lengths(options, &machine.machine);
  take_lengths(tools, machine.machine);
  auto run = std::make_unique<Run>(Run{.machine = std::move(machine), .file = open()});
  run->tools = std::move(tools);
  const Machine& on = run->machine.machine;
  run->read = read_options(options, &on, run->tools);
  ForcePrescan forces(options, on, run->force_input);
  PathPlaces places;
  ProgramScan scan = scan_program(options, run->file, run->read, [&](const Program& window) {
    forces.add(window);
    places.add(window);
    if (options.number_pieces) run->numbers.add(window.text);
  });
  run->program = std::move(scan.program);
  run->is_corrected = scan.is_corrected;
  const std::vector<Remark> axis_warnings = place_program_axes(run->program, run->machine);
  run->tool_models = prepare_tools(on, run->machine.model, run->program.tools);
  run->uncertainty_files = read_uncertainty_files(options, run->machine.machine);
  forces.refuse_unread();
  run->starts.emplace();
  refuse_orientation(*run);
  run->work = place_work(on, run->machine.model, shown_name(options.machine), run->program);
  refuse_tool_axis(*run);
  add_common_shifts(on, run->machine.model, *run->starts, places, run->program, options.threads,
                    run->work.frames);
  run->uncertainties = tip_uncertainties(on, run->machine.model, run->tool_models, run->work.frames);
  if (options.samples > 0) refuse_without_uncertainty(*run, "--samples");
  run->ignored = uncontrolled_axes(on, run->work.frames);
  forces.settle({run->file.bytes, run->program.file, run->read, run->work.frames, run->ignored});
  run->options = compensation_options(options, on);
  if (has_reversals(run->machine.model)) {
    ProgramReader reader(run->file.bytes, run->program.file, run->read);
    run->first_directions = first_directions(run->input(), reader);
  }
  run->sanity = program_sanity({run->machine, run->tool_models, run->tools, run->work, run->program});
  refuse_wrong(run->sanity, on);
  run->facts = facts_of(options, *run);
  run->facts.warnings = axis_warnings;
  add_input_warnings(*run, options.command);
  warn_of(run->program, options.command, console);
  for (const Remark& warning : run->facts.warnings)
    console.warning(run->program.file, warning.line, warning.what);
  return run;
}

MachineInput first_input(const Options& options, Console& console) {
  refuse_stdin_twice(options);
  console.progress("reading");
  return read_machine_input(options);
}

}  // namespace

std::unique_ptr<Run> prepare_run(const Options& options, Console& console) {
  return prepare_run(options, first_input(options, console), console);
}

std::unique_ptr<Run> prepare_run(const Options& options, MachineInput machine, Console& console) {
  return prepared_run(options, std::move(machine), console,
                      [&] { return open_program("program", options.program, options.data_lists, console); });
}

std::unique_ptr<Run> prepare_run(const Options& options, MachineInput machine, const std::string& text,
                                 Console& console) {
  return prepared_run(options, std::move(machine), console, [&] {
    return ProgramFile{{"program", options.program, {}}, FileReader::of_bytes(text)};
  });
}

namespace {

std::size_t most_points(const Options& options, const std::string& dialect) {
  if (options.max_points && !is_robot_dialect(dialect))
    throw InputError(ErrorKind::usage, {},
                     fmt::format("--max-points limits robot programs; {} is not one, leave it out", dialect));
  const SizeLimit* limit = size_limit(dialect);
  return options.max_points.value_or(limit != nullptr ? limit->most : 0);
}

}  // namespace

void prepare_writing(const Options& options, Run& run) {
  run.options.write.header = header_of(options, run);
  run.options.write.most_points = most_points(options, run.program.dialect);
  if (!options.number_pieces) return;
  run.numbers.finish();
  run.options.write.number_pieces = &run.numbers;
}

bool wants_loads(const Run& run) {
  return run.facts.attribution || !run.machine.machine.load_limits.empty();
}

CsvColumns columns_of(const Options& options, const Run& run) {
  return {.attribution = run.facts.attribution,
          .corrected = options.command != Command::predict,
          .bands = !run.uncertainties.empty(),
          .fixture = run.machine.machine.fixture.has_value()};
}

RunTally tally_for(const Options& options, const Run& run) {
  std::optional<PathCurves> curves;
  if (options.report || options.plot)
    curves.emplace(options.command != Command::predict, weighs(run.machine.machine),
                   run.machine.machine.fixture.has_value());
  return RunTally(run.facts.min_block_ms, std::move(curves), tool_sizes(run));
}

}  // namespace counterflex::cli
