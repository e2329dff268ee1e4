#pragma once
/// Recognises the header of corrected programs.
#include <string>

namespace counterflex::cli {

/// Whether the file begins with the header of a corrected program.
bool has_corrected_header(const std::string& path);

/// Whether both files have such a header, of the same original program.
bool are_of_one_program(const std::string& a, const std::string& b);

/// The divided program in the folder of `part` that calls it as its part: it has the header of the same
/// original program. Otherwise empty.
std::string divided_program_of(const std::string& part);

}  // namespace counterflex::cli
