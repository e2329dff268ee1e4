#pragma once
/// Numbers of lines and the header of a written FANUC TP program.
#include <string>
#include <string_view>

namespace counterflex {

/// `text` with the numbers 1, 2, 3, ... before the lines of /MN, in the width that they have. The number of
/// LINE_COUNT becomes that of the last line if `counts`.
std::string with_numbered_lines(std::string text, bool counts);

/// The header's text `line` as remarks with numbers before them. A remark has at most 32 characters: a longer
/// text is continued in further remarks, and hashes are cut off. Each begins with the mark of a header.
std::string tp_remarks(std::string_view line, std::string_view line_end);

}  // namespace counterflex
