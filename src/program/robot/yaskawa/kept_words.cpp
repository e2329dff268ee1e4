#include "program/robot/yaskawa/kept_words.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <set>
#include <string_view>

#include "program/robot/kept_words.hpp"
#include "program/robot/yaskawa/lex.hpp"
#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

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
// stations, and of targets of moves that are not followed, lose their numbers, which insertion changes.
// CR loses its number, a zone.
std::string step_kept_words(std::string_view statement, bool is_followed) {
  std::string text;
  for (std::size_t at = 0; at < statement.size();) {
    const std::size_t end = std::min(statement.find_first_of(" \t", at), statement.size());
    const std::string_view word = statement.substr(at, end - at);
    at = end + 1;
    const std::size_t letters = letters_of_position(word);
    const bool is_target = letters == 1 && is_followed;
    if (word.starts_with("CR="))
      text += "CR=";
    else if (is_target)
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

JbiPositionWords::JbiPositionWords(const Program& program) : source_(jbi_source(program.file, program.text)) {
  for (const std::vector<Span>& list : source_.layout.conditions) {
    std::set<std::string> lines;  // their order has no meaning
    for (const Span line : list) lines.insert(without_spaces(part(program.text, line)));
    std::string& text = conditions_.emplace_back();
    for (const std::string& line : lines) text += line;
  }
  for (const Move& move : program.moves)
    if (const std::vector<Span> numbers = auxiliary_numbers(move); !numbers.empty()) {
      const std::size_t newline = program.text.rfind('\n', numbers.front().begin);
      auxiliary_.push_back(newline == std::string::npos ? 0 : newline + 1);
    }
  std::sort(auxiliary_.begin(), auxiliary_.end());
}

bool JbiPositionWords::is_auxiliary(const JbiPosition& position) const {
  return std::binary_search(auxiliary_.begin(), auxiliary_.end(), position.line_begin);
}

std::string JbiPositionWords::of(Span statement, bool is_followed) const {
  std::string words;
  if (statement.begin < source_.job.positions.end) return words;
  for (const JbiName& name : jbi_names(source_.text, jbi_line_at(source_.text, statement.begin).code)) {
    const std::size_t i = source_.index_of(name);
    if (i == source_.job.positions.list.size()) continue;  // a variable that the job does not have
    const JbiPosition& position = source_.job.positions.list[i];
    words += ' ';
    if (!is_followed && !is_auxiliary(position))
      words += without_spaces(part(source_.text, jbi_values(source_.text, position.line_begin)->text));
    words += conditions_[source_.layout.condition_of[i]];
  }
  return words;
}

bool is_jbi_counts(std::string_view line) {
  return line.starts_with("///NPOS");
}

std::string jbi_surplus(std::string_view text, std::string_view line) {
  constexpr std::array<std::string_view, 3> families{"\nC", "\nBC", "\nEC"};
  std::string result;
  std::size_t at = line.find_first_of("0123456789");
  for (const std::string_view family : families) {
    if (at >= line.size()) break;
    const std::string count(line.substr(at));
    long surplus = std::strtol(count.c_str(), nullptr, 10);
    for (std::size_t i = 0; (i = text.find(family, i)) != std::string_view::npos; i += family.size())
      surplus -= i + family.size() < text.size() && is_digit(text[i + family.size()]);
    result += std::to_string(surplus) + ',';
    at = line.find(',', at);
    if (at < line.size()) ++at;
  }
  return result + std::string(line.substr(std::min(at, line.size())));
}

}  // namespace counterflex
