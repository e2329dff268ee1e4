#include "run/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <utility>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/machine.hpp"
#include "counterflex/program/size_limit.hpp"
#include "counterflex/report/formats.hpp"
#include "counterflex/report/machine_along.hpp"
#include "counterflex/statics/nominal.hpp"
#include "process/exit_status.hpp"
#include "process/standard_output.hpp"
#include "run/facts.hpp"
#include "run/failed_line.hpp"
#include "run/header/header.hpp"
#include "run/program_axes.hpp"
#include "run/reading.hpp"
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
      what = " is not in [tools]: it is " + stiffness_phrase(*tool);
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
                  frame.name);
    const std::string warning = fmt::format(
        "{} as set independently of this machine's errors. The unloaded machine is off by "
        "({}, {}, {}) mm on average along the path, and the correction removes this. If the "
        "part was touched off with this machine, the offset contains this shift already: {}",
        assumed, format_fixed(shift_mm.x(), 4), format_fixed(shift_mm.y(), 4), format_fixed(shift_mm.z(), 4),
        cure);
    if (warnings.insert(warning).second) run.facts.warnings.push_back({0, warning});
  }
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

void warn_of_run(Run& run, Command command, Console& console) {
  const Overview& program = run.program;
  warn_of(program, command, console);
  if (!run.work.assumption.empty()) run.facts.warnings.push_back({0, run.work.assumption});
  for (const Remark& warning : run.facts.warnings) console.warning(program.file, warning.line, warning.what);
}

/// A terminal that shows both streams shows each warning once.
RunReport without_warnings(RunReport report) {
  report.warnings.rows.clear();
  report.warnings.count = 0;
  return report;
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
  warn_of_corrected(*run, options.command);
  warn_of_datum(*run);
  warn_of_orientation(*run);
  warn_of_tools(*run);
  if (auto cycles = remark_of_cycles(run->program, run->force_input.source, options.command))
    run->facts.warnings.push_back(std::move(*cycles));
  warn_of_run(*run, options.command, console);
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

void refuse_what_cannot_be_compensated(const Run& run) {
  if (run.machine.machine.controlled.empty())
    throw InputError(
        ErrorKind::machine_or_force, {shown_name(run.machine.file.path)},
        "controlled = [] allows analyze only; list the components of the tip that the program controls");
  if (run.is_corrected)
    throw InputError(
        ErrorKind::program_text, {run.program.file, 1, 1},
        "the program has the header of a corrected program (COUNTERFLEX 1); a program is not compensated "
        "twice");
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

namespace {

/// The reader has the corrected program open.
std::string located_in_corrected(const Run& run, Failure failure) {
  if (failure.corrected_line == 0) return located(run.program.file, failure);
  if (failure.line > 0) failure.what += fmt::format(" (line {} of the original)", failure.line);
  failure.line = failure.corrected_line;
  return located(run.corrected_name, failure);
}

}  // namespace

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

namespace {

void add_uncertainty(const Options& options, const Run& run, RunReport& report,
                     const std::vector<LoadPlace>& places) {
  const Machine& machine = run.machine.machine;
  const LoadPlace* worst = run.load_places.worst_before();
  report.uncertainty = uncertainty_report(
      machine, worst,
      worst != nullptr ? solve_covariance(*worst, run.uncertainties, &*run.starts) : std::nullopt);
  if (options.samples > 0)
    report.uncertainty->sampled = sample_bands(machine, run.program.tools, run.work.frames, places,
                                               options.samples, run.options.threads);
}

/// A run without a program has no setup sheet.
void add_hashes(const Options& options, RunReport& report, RunFiles& files) {
  std::optional<ProofFacts>& proof = report.facts.proof;
  if (report.error_kind) proof.reset();
  if (!proof || options.command == Command::verify) return;
  for (const FileHash& file : files.complete_program())
    proof->written.push_back({"written", file.path, file.sha256});
}

}  // namespace

RunEnd finish_run(const Options& options, Run& run, RunReport report, const RunTally& tally,
                  RunFiles& files) {
  const MachineInput& on = run.machine;
  const std::vector<LoadPlace> places = run.load_places.places();
  LoadsAlong loads;
  if (wants_loads(run)) loads = solve_loads(on.model, places, run.options.threads, &*run.starts);
  const auto under = [&](double factor) {
    return solve_other_force(places, factor, run.options.threads, &*run.starts);
  };
  const LoadPlace* worst = run.load_places.worst_before();
  if (worst != nullptr && report.before && !report.at_worst)
    if (const auto causes = solve_causes(*worst, &*run.starts))
      report.at_worst = sources_at(worst->at, *causes);
  if (report.facts.attribution && report.without_causes.places == 0)
    add_sensitivity(report, places, under(1 + force_change), under(1 - force_change));
  else if (report.sensitivity)
    add_sensitivity(report, places, under(1 + force_change), under(1 - force_change), under(0));
  if (report.failure && options.command != Command::verify && (options.report || options.json))
    report.failure_place = solve_failed_line(run, report.failure->line);
  if (!run.uncertainties.empty()) add_uncertainty(options, run, report, places);
  std::string machine = "null";
  if (files.with_page()) {
    MachineAlong along = machine_along(on.machine, on.model, places, run.options.threads, &*run.starts);
    along.ranges = tally.travel().axes();
    machine = machine_json(along);
  }
  run.starts.reset();  // the solvers are done; frees memory for the report
  report.sanity = run_sanity(run, report, tally);
  add_loads(report, loads, on.machine);
  if (options.report || options.json) add_texts(report, run.file.by_line());
  report.exit_status = exit_number(report.error_kind);
  add_hashes(options, report, files);
  std::string json = to_json(report);
  if (tally.curves()) files.add_report(report, json, *tally.curves(), machine, run.file.by_line());
  run.file.bytes.refuse_change();  // the file was read more than once
  files.publish(!report.error_kind);
  return {std::move(report), std::move(json)};
}

namespace {

/// The result on a stream that `colour` and `marks` describe.
std::string result_text(const Options& options, const RunReport& report, const RunFiles& files, bool colour,
                        bool marks) {
  if (options.verbose) return details_text(report, colour, marks);
  std::vector<std::string> names;
  for (const FileHash& file : files.published()) names.push_back(file.path);
  return summary_text(report, names, colour);
}

}  // namespace

void print_warnings(const Run& run, const RunReport& report, Console& console) {
  for (const Remark& warning : report.warnings.rows)
    console.warning(run.program.file, warning.line, warning.what);
}

std::optional<ErrorKind> tell_result(const Options& options, const Run& run, const RunEnd& end,
                                     const RunFiles& files, Console& console) {
  print_warnings(run, end.report, console);
  console.finish_warnings();
  if (options.json)
    write_result(end.json);
  else if (files.program_to_stdout())
    console.note(result_text(options, end.report, files, console.colour_error(), console.marks_error()));
  else if (!options.quiet)
    write_painted_result(result_text(options,
                                     console.is_one_terminal() ? without_warnings(end.report) : end.report,
                                     files, console.colour_out(), console.marks_out()));
  return print_failure(run, end.report, console);
}

std::optional<ErrorKind> print_failure(const Run& run, const RunReport& report, Console& console) {
  return print_failure(run, report.failure ? report.failure : refusal_of(report), console);
}

std::optional<ErrorKind> print_failure(const Run& run, const std::optional<Failure>& failure,
                                       Console& console) {
  if (!failure) return std::nullopt;
  console.error(run.corrected_name.empty() ? located(run.program.file, *failure)
                                           : located_in_corrected(run, *failure));
  return failure->kind;
}

}  // namespace counterflex::cli
