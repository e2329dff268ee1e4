#pragma once
/// G codes as a sign of the control of a program.
#include <string_view>

#include "program/dialect.hpp"

namespace counterflex {

/// Whether `dialect` knows all G codes of `text`, outside comments and names.
bool knows_codes(std::string_view text, const Dialect& dialect);

/// Whether `text` has a comment inside a comment, or a comment that is not closed on its line.
bool has_loose_comments(std::string_view text);

/// Whether the beginning of the text names GRBL.
bool names_grbl(std::string_view text);

/// Whether letters follow a ';' outside comments.
bool has_semicolon_comments(std::string_view text);

/// Whether a line begins with ':' and a number.
bool has_colon_numbers(std::string_view text);

}  // namespace counterflex
