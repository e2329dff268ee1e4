#pragma once
/// Which dialect a program is read in.
#include <array>
#include <string>
#include <string_view>

#include "counterflex/program/read_program.hpp"
#include "program/dialect.hpp"

namespace counterflex {

/// A dialect shows at the beginning of a program: bytes of it.
inline constexpr std::size_t bytes_of_dialect = 1 << 20;

/// The dialect of `options`, or the one that `text`, of which only the beginning counts, and the ending of
/// the file's name show: .mpf and .spf are Siemens programs, .h is one of Klartext if it begins like one.
/// Throws `UnknownDialect` if no dialect has that name.
const Dialect& choose_dialect(std::string_view text, const std::string& file, const ReadOptions& options);

/// Axes that are unknown after a tool change.
std::array<bool, 3> axes_of_tool_change(const Dialect& dialect, const ReadOptions& options);

}  // namespace counterflex
