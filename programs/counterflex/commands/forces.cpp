#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "commands/commands.hpp"
#include "commands/fit_forces.hpp"
#include "commands/forces_table.hpp"
#include "commands/forces_walk.hpp"
#include "commands/materials.hpp"
#include "counterflex/compensation/windows.hpp"
#include "process/standard_output.hpp"
#include "run/command_outputs.hpp"
#include "run/reading.hpp"
#include "run/run.hpp"
#include "run/run_files.hpp"
#include "run/work.hpp"

namespace counterflex::cli {
namespace {

/// A program and its forces without a machine. The tool is parallel to z of the program.
struct BareRun {
  ToolLengths tools;
  ReadOptions read;
  ProgramFile file;
  ProgramScan scan;
  ForceInput force_input;
  WorkPlace work;
  std::array<bool, 3> ignored{};
};

/// Whether the orientation of the machine's axes in the program affects the forces.
bool needs_machine_axes(const ForceSource& source, const Overview& program) {
  const auto needs = [](const ForceRule& rule) {
    const auto* profile = std::get_if<ForceProfile>(&rule.content);
    const bool log = profile != nullptr && profile->within && profile->machine_coordinates;
    return log || (frame_of(rule) == ForceFrame::machine && !is_zero(rule));
  };
  return program.commented_force || std::any_of(source.rules.begin(), source.rules.end(), needs);
}

void warn_of_bare_run(const BareRun& run, const Options& options, Console& console) {
  const Overview& program = run.scan.program;
  warn_of(program, options.command, console);
  for (const Remark& warning : run.work.assumptions)
    console.warning(program.file, warning.line, warning.what);
  const ForceSource& source = run.force_input.source;
  if (options.work.empty() && needs_machine_axes(source, program))
    console.warning(program.file, 0,
                    "neither a machine nor --work is given: the axes of the machine frame are taken as those "
                    "of the program");
  if (const auto cycles = remark_of_cycles(program, source, options.command))
    console.warning(program.file, cycles->line, cycles->what);
  if (options.output && source.scale != 1)
    console.warning(
        program.file, 0,
        fmt::format("the profile has the forces times --load-scale {}; a run that reads it with a "
                    "load scale multiplies them again",
                    source.scale));
}

BareRun prepare_bare_run(const Options& options, Console& console) {
  refuse_stdin_twice(options);
  console.progress("reading");
  ToolLengths tools = read_tool_lengths(options, nullptr);
  const ReadOptions read = read_options(options, nullptr, tools);
  BareRun run{std::move(tools),
              read,
              open_program("program", options.program, options.data_lists, console),
              {},
              {},
              {}};
  run.scan = scan_program(options, run.file, run.read);
  run.force_input = read_force_input(options);
  run.work = place_work(options.work, run.scan.program);
  settle_forces({run.file.bytes, run.scan.program.file, run.read, run.work.frames, run.ignored},
                run.force_input.source);
  warn_of_bare_run(run, options, console);
  return run;
}

/// Writes the moves.
class MoveListing {
 public:
  MoveListing(const Options& options, const std::string& program, bool at_platform)
      : program_(program), json_(options.json) {
    if (options.output) profile_.emplace(*options.output);
    if (profile_) profile_->write(profile_head(program, at_platform));
    to_stdout_ = options.output == "-";
    if (!to_stdout_) page_.emplace("-");
    write(json_ ? json_head(program, at_platform) : table_head(program, at_platform));
  }

  /// One warning for consecutive moves with unknown positions.
  void add(const MoveForce& move, Console& console) {
    write(json_ ? json_row(move, is_first_) : table_row(move));
    is_first_ = false;
    cli::add(move, totals_);
    const bool placed = !std::isnan(move.length);
    if (!placed && was_placed_) console.warning(program_, move.line, "no force computed: " + move.why);
    was_placed_ = placed;
    if (!placed) return;
    has_lengths_ = has_lengths_ || move.length > 0;
    if (profile_) profile_->write(profile_rows(program_, move, profile_end_));
  }

  /// Throws `InputError` (ErrorKind::program_text) if a profile would have no row.
  void finish(Console& console) {
    if (profile_ && !has_lengths_)
      throw InputError(ErrorKind::program_text, {program_},
                       "has no feed move with a known length above zero: no force profile can be written");
    write(json_ ? json_foot(totals_) : table_foot(totals_));
    publish_together({if_any(profile_), if_any(page_)});
    if (to_stdout_) console.note(table_foot(totals_));
  }

 private:
  void write(std::string_view text) {
    if (page_) page_->write(text);
  }

  std::string program_;
  bool json_, to_stdout_ = false, is_first_ = true, was_placed_ = true, has_lengths_ = false;
  ForceTotals totals_;
  ProfileEnd profile_end_;
  std::optional<FileWriter> profile_, page_;
};

/// Calls `take` for each window, with its path and the forces of its feed moves. `machine` turns the tool as
/// in a run; without it the tool is parallel to z of the program.
void walk_windows(const PathInput& input, const ForceSource& source, const std::optional<RunInput>& machine,
                  int lines, Console& console, const TakeWindow& take) {
  ProgramReader reader(input.bytes, input.name, input.read);
  std::optional<long> block_number;
  PathEnd end;
  while (reader.next()) {
    ignore_axes(reader.window(), input.ignored);
    const Toolpath path = build_toolpath(reader.window(), input.frames, end);
    end = path.end;
    if (!path.segments.empty())
      console.progress(fmt::format("line {} of {}", path.segments.front().line, lines));
    const std::vector<Matrix3> R_MT = machine ? tool_orientations(*machine, reader.window(), path)
                                              : std::vector<Matrix3>{Matrix3::Identity()};
    take(source, reader.window(), path, move_forces(source, reader.window(), path, R_MT, block_number));
  }
  input.bytes.refuse_change();
}

}  // namespace

void walk_forces(const Options& options, Console& console, const BeginWalk& begin, const TakeWindow& take) {
  if (options.machine.empty()) {
    BareRun run = prepare_bare_run(options, console);
    ForceSource& source = run.force_input.source;
    begin(run.scan.program.file, source);
    return walk_windows({run.file.bytes, run.scan.program.file, run.read, run.work.frames, run.ignored},
                        source, std::nullopt, run.scan.program.lines, console, take);
  }
  const auto run = prepare_run(options, console);
  ForceSource& source = run->force_input.source;
  begin(run->program.file, source);
  walk_windows({run->file.bytes, run->program.file, run->read, run->work.frames, run->ignored}, source,
               run->input(), run->program.lines, console, take);
}

std::optional<ErrorKind> run_forces(const Options& options, Console& console) {
  const ForcesOptions& table = options.forces_table;
  if (table.materials) {
    write_result(materials_page(options.json));
    return std::nullopt;
  }
  if (options.program.empty()) throw InputError(ErrorKind::usage, {}, "PROGRAM is required, or --materials");
  if (table.fit != table.log.has_value())
    throw InputError(ErrorKind::usage, {},
                     table.fit ? "forces fit needs --log, the spindle's power or torque (.csv)"
                               : "--log is for forces fit, which identifies coefficients");
  if (table.fit) return fit_forces(options, console);
  check_output(options, profile_mark);
  std::optional<MoveListing> listing;
  walk_forces(
      options, console,
      [&](const std::string& program, const ForceSource& source) {
        listing.emplace(options, program, acts_at_platform(source));
      },
      [&](const ForceSource&, const Program&, const Toolpath&, const std::vector<MoveForce>& moves) {
        for (const MoveForce& move : moves) listing->add(move, console);
      });
  check_output(options, profile_mark);  // again: a foreign file may have appeared
  listing->finish(console);
  console.finish_warnings();
  return std::nullopt;
}

}  // namespace counterflex::cli
