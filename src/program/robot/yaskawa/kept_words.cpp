#include "program/robot/yaskawa/kept_words.hpp"

#include <algorithm>
#include <string_view>

#include "program/robot/kept_words.hpp"
#include "program/robot/yaskawa/lex.hpp"

namespace counterflex {
namespace {

// The length of "C", "BC", "EC" or "P" before the digits of a position; 0 for other words.
std::size_t letters_of_position(std::string_view word) {
  for (const std::string_view letters : {"C", "BC", "EC", "P"})
    if (word.starts_with(letters) && word.size() > letters.size() &&
        word.find_first_not_of("0123456789", letters.size()) == std::string_view::npos)
      return letters.size();
  return 0;
}

// '@' for the target, which may be another position in the corrected program. Names of base axes and
// stations, and of targets of moves that are not followed, lose their numbers, which insertion changes. CR is
// a zone.
std::string step_kept_words(std::string_view statement, bool is_followed) {
  std::string text;
  for (std::size_t at = 0; at < statement.size();) {
    const std::size_t end = std::min(statement.find_first_of(" \t", at), statement.size());
    const std::string_view word = statement.substr(at, end - at);
    at = end + 1;
    const std::size_t letters = letters_of_position(word);
    const bool is_target = letters == 1 && is_followed;
    if (word.starts_with("CR=")) continue;
    if (is_target)
      text += '@';
    else if (letters > 0 && word[0] != 'P')
      text.append(word.substr(0, letters)).append("@");
    else
      text.append(word);
  }
  return text;
}

}  // namespace

std::string jbi_kept_words(const Program& program, const Move& move) {
  return step_kept_words(statement_without_comment(program, move, jbi_comment),
                         !target_numbers(move).empty());
}

}  // namespace counterflex
