#pragma once
/// Tool lengths as LinuxCNC keeps them.
#include <map>
#include <string>
#include <string_view>

namespace counterflex {

/// Lengths of tools (m) by number. Each line of the table is words `T1 P1 Z50.0 D6`, blank, or a comment
/// after
/// `;`; lengths are Z, in mm, 0 where there is none. Throws `InputError` (Exit::machine_or_force) with line
/// and column for words that a table does not have, a line without T, and a tool that stands there twice.
std::map<long, double> read_tool_table(std::string_view text, const std::string& file);

}  // namespace counterflex
