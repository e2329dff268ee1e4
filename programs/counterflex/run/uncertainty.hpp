#pragma once
#include <vector>

#include "counterflex/machine/machine.hpp"
#include "counterflex/report/report.hpp"
#include "settings/options.hpp"

namespace counterflex::cli {

/// Takes the uncertainty of --uncertainty, and reads the covariance that it or the machine file names.
/// Returns the files. For a command without --uncertainty, which shows no bands, `machine` loses its
/// uncertainty. Throws `InputError` (ErrorKind::machine_or_force).
std::vector<InputFile> read_uncertainty_files(const Options& options, Machine& machine);

}  // namespace counterflex::cli
