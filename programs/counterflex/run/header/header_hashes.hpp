#pragma once
/// Compares the header of a corrected program with the inputs of a run.
#include "run/run.hpp"

namespace counterflex::cli {

/// Warnings for inputs whose hashes in the header of a corrected program differ from those of this run
/// (machine, force files, tool table), for other work offsets, tool lengths, forces and temperatures, and for
/// different options of reading.
std::vector<std::string> other_inputs_of_header(const std::string& text, const Options& options,
                                                const Run& run);

}  // namespace counterflex::cli
