#pragma once
/// Detects the languages of robots.
#include <string_view>

namespace counterflex {

struct RobotLanguage {
  std::string_view name;       ///< "KUKA KRL"; empty: not a robot language
  std::string_view dialect{};  ///< in which it is read; empty: not a robot program
};

/// The language of a robot program. Its first statement, after blank lines and comments, decides.
RobotLanguage robot_language(std::string_view text);

}  // namespace counterflex
