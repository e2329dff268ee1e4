#include "run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "counterflex/geometry/units.hpp"
#include "counterflex/report/formats.hpp"
#include "facts.hpp"

namespace counterflex::cli {
namespace {

/// Standard input can be read once.
void refuse_stdin_twice(const Options& options) {
  const std::string forces = options.forces.value_or(""), tools = options.tool_table.value_or("");
  int count = 0;
  for (const std::string* path : {&options.program, &options.corrected, &options.machine, &forces, &tools})
    count += *path == "-";
  if (count > 1) throw InputError(Exit::usage, {}, "standard input (-) can be only one of the inputs");
}

constexpr int orientations_of_segment = 9;

/// The nominal tool's at equal fractions of every segment, or in its middle.
std::vector<Matrix3> sampled_orientations(const Model& model, const Toolpath& path, int each) {
  const Matrix3 R_home = tip(model.mechanism, model.home).R;
  std::vector<Matrix3> R_MT;
  NominalPath nominal(model, model.home);
  for (const Segment& segment : path.segments)
    for (int k = 0; k < each; ++k) {
      const double u = each == 1 ? 0.5 : static_cast<double>(k) / (each - 1);
      nominal.go_to({R_home, point_at(segment.wanted, u)});  // a failure is said where it is solved
      R_MT.push_back(tip(model.mechanism, nominal.configuration()).R);
    }
  return R_MT;
}

/// Orientations of the tool along the path: one for all where every move has home's, else several a segment.
std::vector<Matrix3> tool_orientations(const Model& model, const Toolpath& path, const ForceSource& source) {
  const Matrix3 R_home = tip(model.mechanism, model.home).R;
  const bool needed = source.profile && (source.profile->frame == ForceFrame::tool ||
                                         source.profile->frame == ForceFrame::feed);
  if (!needed || path.segments.empty()) return {R_home};
  const std::vector<Matrix3> in_the_middle = sampled_orientations(model, path, 1);
  const bool turns = std::any_of(in_the_middle.begin(), in_the_middle.end(),
                                 [&](const Matrix3& R) { return (R - R_home).norm() > 1e-9; });
  return turns ? sampled_orientations(model, path, orientations_of_segment) : std::vector{R_home};
}

/// A component of the position that the machine does not control has to keep its value.
void refuse_uncontrolled_moves(const Run& run) {
  const auto& controlled = run.machine.machine.controlled;
  if (controlled.empty() || run.path.segments.empty()) return;
  const Vector3 first = run.path.segments.front().wanted.start;
  for (int c = 0; c < 3; ++c) {
    if (std::find(controlled.begin(), controlled.end(), static_cast<Component>(c)) != controlled.end())
      continue;
    for (const Segment& segment : run.path.segments)
      for (const Vector3& p : points_along(segment.wanted))
        if (std::abs(p[c] - first[c]) > 1e-9)
          throw InputError(
              Exit::program_text, {run.program.program.file, segment.line, 1},
              fmt::format("the move changes {} of the machine frame from {:.6g} to {:.6g} mm, which the "
                          "machine does not control",
                          "xyz"[c], first[c] / mm, p[c] / mm));
  }
}

bool controls(const Machine& machine, int component) {
  const auto& list = machine.controlled;
  return std::find(list.begin(), list.end(), static_cast<Component>(component)) != list.end();
}

/// Axes of the program along which the machine has nothing to control.
std::array<bool, 3> uncontrolled_axes(const Machine& machine, const std::vector<WorkFrame>& frames) {
  std::array<bool, 3> axes{};
  if (machine.controlled.empty()) return axes;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    bool moves_controlled = false;
    for (const WorkFrame& frame : frames)
      for (int c = 0; c < 3; ++c)
        moves_controlled =
            moves_controlled || (controls(machine, c) && std::abs(frame.X_MW.R(c, axis)) > 1e-12);
    axes[static_cast<std::size_t>(axis)] = !moves_controlled;
  }
  return axes;
}

/// Orientations that the machine controls, and that a program of X, Y and Z does not state.
void warn_of_orientation(Run& run) {
  const Machine& machine = run.machine.machine;
  if (std::none_of(machine.controlled.begin(), machine.controlled.end(),
                   [](Component c) { return c > Component::z; }))
    return;
  run.facts.warnings.push_back({0,
                                "the machine controls the tool's orientation, which the program does not "
                                "state: home's is commanded, and its "
                                "error stays (see the largest rotation)"});
}

CompensationOptions compensation_options(const Options& options, const Machine& machine) {
  CompensationOptions result;
  result.method = options.method;
  result.tolerance = options.tolerance;
  result.max_correction = options.max_correction.value_or(machine.max_correction);
  result.blend = options.blend;
  result.threads = options.threads;
  result.write.decimals = options.decimals;
  return result;
}

/// The feed of a cycle is the control's own: no part of the path, so that no force acts there.
void warn_of_cycles(Run& run) {
  const Program& program = run.program.program;
  const auto cycle = std::find_if(program.moves.begin(), program.moves.end(),
                                  [](const Move& move) { return move.cycle.has_value(); });
  const ForceSource& source = run.force_input.source;
  const bool forces = source.constant || source.profile ||
                      std::any_of(program.moves.begin(), program.moves.end(),
                                  [](const Move& move) { return move.force && !move.force->isZero(0); });
  if (cycle == program.moves.end() || !forces || source.scale == 0) return;
  run.facts.warnings.push_back({cycle->line, "holes of cycles are corrected without the cutting force"});
}

void warn_of_run(Run& run, Console& console) {
  const Program& program = run.program.program;
  warn_of(program, console);
  for (const ForceNote& note : run.forces->notes()) console.warning(program.file, note.line, note.what);
  if (!run.work.assumption.empty()) run.facts.warnings.push_back({0, run.work.assumption});
  for (const Remark& warning : run.facts.warnings) console.warning(program.file, warning.line, warning.what);
  console.detail(fmt::format("{}: dialect {}, {} blocks, {} moves, {} segments", program.file,
                             program.dialect, program.block_count, program.moves.size(),
                             run.path.segments.size()));
}

}  // namespace

Job Run::job() const {
  return {machine.model, program.program, path, *forces, options, read};
}

RunContext Run::context() const {
  return {machine.machine, options, path.frames, overview, facts};
}

std::unique_ptr<Run> prepare_run(const Options& options, Console& console) {
  refuse_stdin_twice(options);
  console.progress("reading");
  auto run = std::make_unique<Run>();
  run->machine = read_machine_input(options);
  run->tools = read_tool_lengths(options, &run->machine.machine);
  run->read = read_options(options, &run->machine.machine, run->tools);
  run->program = read_program_input("program", options.program, options, &run->machine.machine, run->read);
  const Program& program = run->program.program;
  run->force_input = read_force_input(options, program);
  run->work = place_work(run->machine.machine, run->machine.model, shown_name(options.machine), program);
  run->ignored = uncontrolled_axes(run->machine.machine, run->work.frames);
  ignore_axes(run->program.program, run->ignored);
  run->overview = overview_of(program);
  run->path = build_toolpath(program, run->work.frames);
  refuse_uncontrolled_moves(*run);
  const ForceSource& source = run->force_input.source;
  run->forces.emplace(source, program, run->path, tool_orientations(run->machine.model, run->path, source));
  run->options = compensation_options(options, run->machine.machine);
  run->facts = facts_of(options, *run);
  warn_of_orientation(*run);
  warn_of_cycles(*run);
  warn_of_run(*run, console);
  return run;
}

void refuse_what_cannot_be_compensated(const Run& run) {
  const Program& program = run.program.program;
  if (run.machine.machine.controlled.empty())
    throw InputError(
        Exit::machine_or_force, {shown_name(run.machine.file.path)},
        "controlled = [] allows analysis alone; name the components of the tip that the program controls");
  if (is_corrected(program))
    throw InputError(
        Exit::program_text, {program.file, 1, 1},
        "the header says that this program is already corrected (COUNTERFLEX 1); nothing is compensated "
        "twice");
}

void deliver(const Options& options, const OutputPaths& paths, const RunReport& report,
             const std::vector<Waypoint>& waypoints, const std::string* program, Console& console) {
  const CsvColumns columns{true, report.command != counterflex::Command::predict};
  std::vector<OutputFile> files;
  if (!paths.report_json.empty()) files.push_back({paths.report_json, to_json(report)});
  std::size_t next_row = 0;
  if (!paths.report_csv.empty())
    files.push_back({paths.report_csv, csv_header() + csv_rows(waypoints, columns, next_row)});
  if (program != nullptr) files.push_back({paths.program, *program});
  write_files(files);
  console.finish_warnings();
  if (options.json) return write_result(to_json(report));
  if (paths.program == "-") return console.note(summary_text(report, console.colour_error()));
  write_result(summary_text(report, console.colour_out()));
}

}  // namespace counterflex::cli
