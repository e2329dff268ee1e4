#pragma once
/// Text of inputs (names of files, comments, values) as it is shown.
#include <string>
#include <string_view>

namespace counterflex {

/// `text` with every control character replaced by its code: those of ASCII and of U+0080 to U+009F, line
/// ends among them, and those that turn the direction of text or break lines (U+202E ...). A terminal or a
/// page cannot be changed by the result, and it is one line. Other bytes stay, tabs become blanks.
std::string without_controls(std::string_view text);

/// The same for each line of `text`: its line ends stay.
std::string lines_without_controls(std::string_view text);

}  // namespace counterflex
