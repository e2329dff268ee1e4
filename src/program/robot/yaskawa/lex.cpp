#include "program/robot/yaskawa/lex.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr auto family_names = std::to_array<std::string_view>({"C", "BC", "EC", "P", "BP", "EX"});

std::vector<Span> split(std::string_view text, Span code, std::string_view separators) {
  std::vector<Span> words;
  text = text.substr(0, code.end);  // positions have no blanks: the next one may be far
  for (std::size_t at = code.begin; at < code.end;) {
    const std::size_t stop = std::min(text.find_first_of(separators, at), code.end);
    if (stop > at) words.push_back({at, stop});
    at = stop + 1;
  }
  return words;
}

}  // namespace

std::optional<JbiName> jbi_name(std::string_view text, Span word) {
  std::size_t digits = word.begin;
  while (digits < word.end && is_letter(text[digits])) ++digits;
  const std::string letters = jbi_word(text.substr(word.begin, digits - word.begin));
  constexpr std::size_t most_digits = 9;
  if (digits == word.end || word.end - digits > most_digits) return std::nullopt;
  for (std::size_t family = 0; family < family_names.size(); ++family) {
    if (letters != family_names[family]) continue;
    JbiName name{static_cast<JbiFamily>(family), 0, word, {digits, word.end}};
    const auto [end, error] = std::from_chars(text.data() + digits, text.data() + word.end, name.number);
    if (error != std::errc() || end != text.data() + word.end) return std::nullopt;
    return name;
  }
  return std::nullopt;
}

std::vector<Span> jbi_words(std::string_view text, Span code) {
  return split(text, code, " \t");
}

std::vector<JbiName> jbi_names(std::string_view text, Span code) {
  std::vector<JbiName> names;
  for (const Span word : split(text, code, " \t(),"))
    if (const auto name = jbi_name(text, word)) names.push_back(*name);
  return names;
}

std::string jbi_word(std::string_view text) {
  std::string word(text);
  for (char& c : word) c = upper(c);
  return word;
}

RobotLine jbi_line_at(std::string_view text, std::size_t at) {
  RobotLine line;
  line.line_end.end = at;
  next_robot_line(text, jbi_comment, line);
  return line;
}

}  // namespace counterflex
