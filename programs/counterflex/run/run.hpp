#pragma once
/// One program on one machine, read and ready: what compensate, predict and verify have in common.
#include <memory>
#include <optional>

#include "counterflex/compensation/loads_along.hpp"
#include "counterflex/compensation/windows.hpp"
#include "counterflex/report/run_tally.hpp"
#include "process/console.hpp"
#include "run/inputs.hpp"
#include "run/outputs.hpp"
#include "run/work.hpp"
#include "settings/options.hpp"

namespace counterflex::cli {

struct Run {
  MachineInput machine;
  ProgramFile file;
  Overview program;
  BlockNumbers numbers{};        ///< of the program, with --number-pieces
  bool is_corrected = false;     ///< the program carries the header of a corrected one
  std::string corrected_name{};  ///< verify: of the corrected program, in diagnostics
  ToolLengths tools;
  ForceInput force_input;
  WorkPlace work;
  std::array<bool, 3> ignored{};  ///< program axes along which the machine controls nothing
  CompensationOptions options;
  ReadOptions read;  ///< with which the program is read
  RunFacts facts;
  ToolModels tool_models;  ///< of the program's tools
  std::optional<StartTables> starts{};
  LoadPlaces load_places{};  ///< of the path, where loads are asked for
  SanityChecks sanity{};     ///< known before it runs

  RunInput input() const;
  RunContext context() const;
};

/// Standard input can be read once. Throws `InputError` (Exit::usage).
void refuse_stdin_twice(const Options& options);

/// Reads everything, the program to its end, and warns of what was remarked. Throws `InputError`; nothing has
/// been written then.
std::unique_ptr<Run> prepare_run(const Options& options, Console& console);

/// Refuses a machine that controls nothing (Exit::machine_or_force) and a program that carries the header of
/// a corrected one (Exit::program_text).
void refuse_what_cannot_be_compensated(const Run& run);

/// Whether the loads along the path are asked for: with their causes, or by the limits of the machine.
bool wants_loads(const Run& run);

/// Sets how the corrected program is written: its header, and the numbers of its pieces.
void prepare_writing(const Options& options, Run& run);

/// The windows of a run's program, once from its beginning.
class Windows {
 public:
  Windows(Run& run, Console& console, std::size_t least_moves = window_moves);

  const ProgramReader& reader() const { return reader_; }
  JobWindows& jobs() { return jobs_; }

  /// Of a window that has been read: shows progress. Throws `InputError` (Exit::program_text) for a move
  /// along what the machine does not control.
  void check(const Job& window);
  /// Warns of what is noted of its forces.
  void warn(const Job& window);

 private:
  void refuse_uncontrolled_moves(const Job& job);

  const Run& run_;
  Console& console_;
  ProgramReader reader_;
  JobWindows jobs_;
  std::optional<Vector3> first_;  ///< where the path begins
};

/// What the run's waypoints and windows are to be added to: with the path's curves where a page is to show
/// them.
RunTally tally_for(const Options& options, const Run& run);

/// What a run has come to; its files have their names.
struct RunEnd {
  RunReport report;
  std::string json;  ///< of the report
};

/// Completes the report and gives the run's files their names. Throws `InputError` (Exit::transient_io).
RunEnd finish_run(const Options& options, Run& run, RunReport report, const RunTally& tally, RunFiles& files);

/// Says the failure, if there is one; its exit status.
Exit exit_of(const Run& run, const std::optional<Failure>& failure, Console& console);

/// The same for the verdict of a report.
Exit exit_of(const Run& run, const RunReport& report, Console& console);

/// Says the result: the summary, or the JSON document, on standard output; the summary on standard error
/// where the corrected program has standard output. Then the failure, if there is one; its exit status.
Exit tell_result(const Options& options, const Run& run, const RunEnd& end, const RunFiles& files,
                 Console& console);

/// Finishes the run and says its result.
Exit deliver(const Options& options, Run& run, RunReport report, const RunTally& tally, RunFiles& files,
             Console& console);

}  // namespace counterflex::cli
