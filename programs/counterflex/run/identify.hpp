#pragma once
/// Identifies a machine from measurement files.
#include <optional>
#include <string>
#include <string_view>
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

/// The text of the identified machine file, for the one that was read from `file`: a first line names the
/// measurements, in the place of that of an earlier run.
std::string identified_text(std::string_view text, const std::string& file, const Identification& found,
                            const std::vector<std::string>& measurements);

/// "series_B.csv, series_C.csv": names without folders, so that the file is the same wherever it is made.
std::string names_of(const std::vector<std::string>& files);

}  // namespace counterflex::cli
