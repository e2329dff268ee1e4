#pragma once
/// Chooses the dialect in which a program is read.
#include <array>
#include <string>
#include <string_view>

#include "counterflex/program/read_program.hpp"
#include "program/dialect.hpp"

namespace counterflex {

/// Number of bytes at the beginning of a program in which its dialect is searched.
inline constexpr std::size_t bytes_of_dialect = 1 << 20;

/// The dialect of `options`. For auto, the beginning of `text` and the extension of the file name decide:
/// .mpf and .spf are Siemens programs, .h is Klartext if the text begins like Klartext. Throws if
/// the dialect does not exist (ErrorKind::usage).
const Dialect& choose_dialect(std::string_view text, const std::string& file, const ReadOptions& options);

/// Axes whose position is unknown after a tool change.
std::array<bool, 3> axes_of_tool_change(const Dialect& dialect, const ReadOptions& options);

}  // namespace counterflex
