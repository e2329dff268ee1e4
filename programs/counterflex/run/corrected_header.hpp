#pragma once
/// The header that corrected programs begin with.
#include <string>

namespace counterflex::cli {

/// Whether the file begins as a corrected program.
bool has_corrected_header(const std::string& path);

/// Whether the header of the corrected program `output` names the bytes of `program`. False where one of them
/// cannot be read.
bool is_corrected_from(const std::string& output, const std::string& program);

}  // namespace counterflex::cli
