#pragma once
/// Identifies a machine from measurement files.
#include <optional>
#include <string>
#include <vector>

#include "counterflex/identify/identify.hpp"
#include "run/inputs.hpp"

namespace counterflex::cli {

/// Throws `InputError` (ErrorKind::usage) for wrong values of `options.identify`, before files are read.
void refuse_wrong_values(const Options& options);

/// Reads the measurements of the options and identifies the machine. Returns the kind of the error if the
/// program of --for cannot be solved, which is printed. Throws `InputError`.
std::optional<ErrorKind> identify_run(const Options& options, const MachineInput& input, Console& console,
                                      Identification& found);

/// "series_B.csv, series_C.csv": names without folders, so that the file is the same wherever it is made.
std::string names_of(const std::vector<std::string>& files);

}  // namespace counterflex::cli
