#pragma once
/// The mark of the lines of a guard: a comment with a hash of the line. Readers take a line with the right
/// mark as a comment. A line that was edited, or that counterflex did not write, has no right mark.
#include <string>
#include <string_view>

namespace counterflex {

/// "CF 1A2B3C4D": the mark for a line that is `before` + mark + `behind`.
std::string guard_mark(std::string_view before, std::string_view behind);

/// The line with its mark.
std::string marked_line(std::string_view before, std::string_view behind);

/// Whether `line` has its right mark. Blanks at its ends do not count.
bool is_guard_line(std::string_view line);

}  // namespace counterflex
