#pragma once
/// One program on one machine, read and ready: what compensate, predict and verify have in common.
#include <memory>
#include <optional>

#include "console.hpp"
#include "counterflex/report/run_tally.hpp"
#include "inputs.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "work.hpp"

namespace counterflex::cli {

struct Run {
  MachineInput machine;
  ProgramInput program;
  ToolLengths tools;
  ForceInput force_input;
  WorkPlace work;
  std::array<bool, 3> ignored{};  ///< program axes along which the machine controls nothing
  Toolpath path;                  ///< wanted
  std::optional<PathForces> forces;
  CompensationOptions options;
  ReadOptions read;  ///< with which the program was read
  RunFacts facts;
  Overview overview;  ///< of the program, its ignored axes made known

  Job job() const;
  RunContext context() const;
};

/// Reads everything and warns of what was remarked. Throws `InputError`; nothing has been written then.
std::unique_ptr<Run> prepare_run(const Options& options, Console& console);

/// Refuses a machine that controls nothing (Exit::machine_or_force) and a program that carries the header of
/// a corrected one (Exit::program_text).
void refuse_what_cannot_be_compensated(const Run& run);

/// Texts of the comments that a corrected program starts with.
std::vector<std::string> header_of(const Run& run);

/// Writes the report's files, and says the result: the summary, or the JSON document, on standard output; the
/// summary on standard error where the corrected program has standard output. `program` is the corrected
/// program, if it is to be written.
void deliver(const Options& options, const OutputPaths& paths, const RunReport& report,
             const std::vector<Waypoint>& waypoints, const std::string* program, Console& console);

}  // namespace counterflex::cli
