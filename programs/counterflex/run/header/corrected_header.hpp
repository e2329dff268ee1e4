#pragma once
/// Recognises the header of corrected programs.
#include <string>
#include <vector>

namespace counterflex::cli {

/// Whether the file begins with the header of a corrected program.
bool has_corrected_header(const std::string& path);

/// Whether both files have such a header, of the same original program.
bool are_of_one_program(const std::string& a, const std::string& b);

/// The divided program in the folder of `part` that calls it as its part: it has the header of the same
/// original program. Otherwise empty.
std::string divided_program_of(const std::string& part);

/// Whether the header of the corrected program `output` has the hashes of `files`: the program and its data
/// lists. False if one of them cannot be read.
bool is_corrected_from(const std::string& output, const std::vector<std::string>& files);

}  // namespace counterflex::cli
