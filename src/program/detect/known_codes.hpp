#pragma once
/// G codes as a sign of the control that a program is for.
#include <string_view>

#include "program/dialect.hpp"

namespace counterflex {

/// Whether `dialect` knows all G codes of `text`, outside comments and names.
bool knows_codes(std::string_view text, const Dialect& dialect);

/// Whether a comment of `text` stands inside another, or does not end on its line.
bool has_loose_comments(std::string_view text);

/// Whether the beginning of the text speaks of GRBL.
bool names_grbl(std::string_view text);

/// Whether words, in letters, follow a ';' outside comments.
bool has_semicolon_comments(std::string_view text);

/// Whether a line begins with ':' and a number.
bool has_colon_numbers(std::string_view text);

}  // namespace counterflex
