#pragma once
/// Recognises the header of corrected programs.
#include <string>

namespace counterflex::cli {

/// Whether the file begins with the header of a corrected program.
bool has_corrected_header(const std::string& path);

/// Whether the header of the corrected program `output` has the hash of `program`. False if one of them
/// cannot be read.
bool is_corrected_from(const std::string& output, const std::string& program);

}  // namespace counterflex::cli
