#pragma once
/// Whether a corrected program was made for the inputs of a run.
#include "run/run.hpp"

namespace counterflex::cli {

/// Warnings about inputs whose hashes in the header of a corrected program, at the beginning of its text, are
/// not those of this run: its machine, files of forces and table of tools. And of options with which the
/// original was read.
std::vector<std::string> other_inputs_of_header(const std::string& text, const Run& run);

}  // namespace counterflex::cli
