#pragma once
/// One program on one machine, read and ready. Common to compensate, predict and verify.
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "counterflex/compensation/uncertainty.hpp"
#include "counterflex/compensation/windows.hpp"
#include "counterflex/report/run_tally.hpp"
#include "process/console.hpp"
#include "run/inputs.hpp"
#include "run/run_files.hpp"
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
  std::array<bool, 3> ignored{};  ///< program axes that the machine does not control
  CompensationOptions options;
  ReadOptions read;  ///< used for the program
  RunFacts facts;
  ToolModels tool_models;  ///< of the program's tools
  std::vector<InputFile> uncertainty_files{};
  TipUncertainties
      uncertainties{};  ///< of the machine with each tool; empty: the machine states no uncertainty
  std::optional<StartTables> starts{};
  Directions first_directions{};      ///< in which actuators with lost motion move first
  std::vector<double> spins{};        ///< as in `RunInput`; empty: none (--free spin)
  std::vector<bool> as_programmed{};  ///< as in `RunInput`; empty: none (--only-significant)
  LoadPlaces load_places{};           ///< of the path, if loads are requested
  SanityChecks sanity{};              ///< checks before the run

  RunInput input() const;
  RunContext context() const;
};

/// Throws `InputError` (ErrorKind::usage) if standard input is used more than once.
void refuse_stdin_twice(const Options& options);

/// Reads all inputs, the program to its end, and prints remarks as warnings. Throws `InputError` before any
/// file is written.
std::unique_ptr<Run> prepare_run(const Options& options, Console& console);

/// The same on a machine that was read before.
std::unique_ptr<Run> prepare_run(const Options& options, MachineInput machine, Console& console);

/// The same for a program that is not a file: `options.program` is its name.
std::unique_ptr<Run> prepare_run(const Options& options, MachineInput machine, const std::string& text,
                                 Console& console);

/// Whether loads along the path are computed: if causes are requested, or if the machine has load limits.
bool wants_loads(const Run& run);

/// Sets how the corrected program is written: its header, and the numbers of its pieces.
void prepare_writing(const Options& options, Run& run);

/// The columns of the run's CSV report.
CsvColumns columns_of(const Options& options, const Run& run);

/// The tally for waypoints and windows of the run. It has the curves of the path if a page is written.
RunTally tally_for(const Options& options, const Run& run);

}  // namespace counterflex::cli
