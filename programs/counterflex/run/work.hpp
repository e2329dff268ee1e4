#pragma once
/// Places a program in the machine frame.
#include <string>
#include <vector>

#include "counterflex/compensation/loads_along.hpp"
#include "counterflex/program/overview.hpp"
#include "counterflex/statics/equilibrium.hpp"
#include "counterflex/toolpath/toolpath.hpp"

namespace counterflex::cli {

struct WorkPlace {
  std::vector<WorkFrame>
      frames;  ///< by index into Program::frames; nameless where the machine has no table of offsets
  std::string assumption;  ///< worth a warning: moves before any offset is selected, several offsets without
                           ///< a table; empty: none
};

/// The offsets that moves of `program` use, G54 where they select none, and their true places: a datum
/// touched off lies where the unloaded machine's tip was. Throws `InputError` (Exit::machine_or_force) where
/// the table does not have one, or where the touched point is not reached.
WorkPlace place_work(const Machine& machine, const Model& model, const std::string& machine_file,
                     const Overview& program);

/// The same without a machine, by the texts of --work, which may be none: then all offsets are the machine
/// frame. Throws `InputError` (Exit::usage) where they make no sense or do not give an offset in use.
WorkPlace place_work(const std::vector<std::string>& given, const Overview& program);

/// The machine of a run with its tools, and where solutions start.
struct RunModels {
  const Model& model;
  const ToolModels& tools;
  const StartTables* starts;
};

/// Fills the common shift of the frames in use whose datum is not stated. `places` are those of the program.
void add_common_shifts(const Machine& machine, const RunModels& models, const PathPlaces& places,
                       const Overview& program, std::vector<WorkFrame>& frames);

}  // namespace counterflex::cli
