#pragma once
/// The sanity block of a run, and of `check`.
#include "run/run.hpp"

namespace counterflex::cli {

/// A machine with the tools that a program uses, and where the program lies.
struct PlacedProgram {
  const MachineInput& machine;
  const ToolModels& tools;
  const ToolLengths& lengths;
  const WorkPlace& work;
  const Overview& program;
};

/// Checks of a machine file: each of its work offsets may be in use.
SanityChecks machine_sanity(const Machine& machine, const Model& model);

/// Checks of a machine and a program before the run.
SanityChecks program_sanity(const PlacedProgram& placed);

/// Throws `InputError` (ErrorKind::machine_or_force) at [tool] if the tool points into the work.
void refuse_wrong(const SanityChecks& checks, const Machine& machine);

/// All checks of a run: those before it, and those of the path in `tally`.
SanityChecks run_sanity(const Run& run, const RunReport& report, const RunTally& tally);

}  // namespace counterflex::cli
