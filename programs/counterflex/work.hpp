#pragma once
/// Places a program in the machine frame.
#include <string>

#include "counterflex/program/program.hpp"
#include "counterflex/statics/equilibrium.hpp"

namespace counterflex::cli {

struct WorkPlace {
  std::string
      name;   ///< of the offset; empty: the machine has no table of offsets, and all are the machine frame
  Pose X_MW;  ///< as the control has it
  Vector3 datum_shift =
      Vector3::Zero();     ///< of the wanted path, where the datum was touched off with this machine (m)
  std::string assumption;  ///< worth a warning: the program selects no offset; empty: it does
};

/// The offset that `program` selects, G54 where it selects none, and its true place: a datum touched off lies
/// where the unloaded machine's tip was. Throws `InputError`: Exit::machine_or_force where the table does not
/// have it, or where the touched point is not reached; Exit::program_text where the program selects more than
/// one.
WorkPlace place_work(const Machine& machine, const Model& model, const std::string& machine_file,
                     const Program& program);

/// `X_MW` moved to where the wanted path is.
Pose wanted_frame(const WorkPlace& work);

}  // namespace counterflex::cli
