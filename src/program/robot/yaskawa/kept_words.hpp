#pragma once
/// What of a step of a Yaskawa job correction never changes.
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/program/program.hpp"
#include "program/robot/yaskawa/source.hpp"

namespace counterflex {

/// As `kept_words`, of a job of Yaskawa.
std::string jbi_kept_words(const Program& program, const Move& move);

/// What takes the place of the numbers of positions in statements: `PositionWords`.
class JbiPositionWords {
 public:
  explicit JbiPositionWords(const Program& program);

  /// `is_followed`: without values, which are judged.
  std::string of(Span statement, bool is_followed) const;

 private:
  bool is_auxiliary(const JbiPosition& position) const;

  JbiSource source_;
  std::vector<std::string> conditions_;  // pseudo instructions, as the lists of the layout
  std::vector<std::size_t> auxiliary_;   // first bytes of the points inside of circles that are followed
};

/// Whether a line is "///NPOS 5,0,0,1,0,0".
bool is_jbi_counts(std::string_view line);

/// Such a line with the surplus of each of its first numbers over the positions C, BC and EC of `text` in the
/// place of the number: insertion counts both on.
std::string jbi_surplus(std::string_view text, std::string_view line);

}  // namespace counterflex
