#pragma once
/// Detects the languages of robots.
#include <string_view>

namespace counterflex {

/// The dialect of a robot program, or nothing. Its first statement, after blank lines and comments, decides.
std::string_view robot_dialect(std::string_view text);

}  // namespace counterflex
