#include "program/siemens/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "counterflex/files/text.hpp"
#include "program/expand/control_flow.hpp"
#include "program/siemens/names.hpp"

namespace counterflex {
namespace {

bool is_name_character(char c) {
  return is_letter(c) || is_digit(c) || c == '_' || c == '$';
}

/// Skips an operator; false if there is no operator at the scanner.
bool skip_operator(Scanner& s) {
  const std::size_t begin = s.at;
  while (s.at < s.end && std::string_view("+-*/<>=").find(s.peek()) != std::string_view::npos) ++s.at;
  if (s.at > begin) return true;
  const std::string_view name = siemens_name_at(s);
  const bool found = is_siemens_operator(name);
  if (found) s.at += name.size();
  return found;
}

std::optional<double> plain_number(std::string_view text) {
  return text.find_first_not_of("+-.0123456789") == std::string_view::npos ? read_number(text) : std::nullopt;
}

/// "SIN", "_DEPTH2", and of text that begins with a number or a numbered parameter only these: "R1" of
/// "R1F5".
std::size_t size_of_operand(std::string_view name) {
  const bool numbered = is_digit(name[0]) || (is_letter(name[0]) && name.size() > 1 && is_digit(name[1]));
  return numbered ? std::min(name.find_first_not_of("0123456789", 1), name.size()) : name.size();
}

/// "DIV" of "DIV2", and "EX" before the exponent of a number; 0 for other names.
std::size_t size_of_operator(const Scanner& s) {
  const std::string_view name = siemens_name_at(s);
  const std::string_view letters = name.substr(0, name.find_first_of("0123456789"));
  return is_siemens_operator(letters) || is_word(letters, "EX") ? letters.size() : 0;
}

void skip_quoted(Scanner& s) {
  const char quote = s.peek();
  for (++s.at; s.at < s.end && s.peek() != quote; ++s.at) {
  }
  s.at = std::min(s.at + 1, s.end);
}

/// The value from `begin` ends at the word at the scanner. Refuses an expression that does not end in a
/// bracket: "R1F600".
void end_before_word(const Scanner& s, std::size_t begin) {
  const std::string_view value = s.text.substr(begin, s.at - begin);
  if (plain_number(value) || std::string_view(")]\"'").find(value.back()) != std::string_view::npos) return;
  const std::string_view name = siemens_name_at(s);
  s.refuse_at(s.at,
              fmt::format("'{}' is directly behind '{}': only behind a plain number or a bracket does a word "
                          "need no blank; write a blank before '{}'",
                          name, value, name));
}

/// An assigned expression: values with operators between them.
void skip_assigned(Scanner& s) {
  for (bool more = true; more; more = skip_operator(s)) {
    s.skip_blanks();
    skip_siemens_value(s);
    s.skip_blanks();
  }
}

int decimals_in_plain(std::string_view number) {
  const std::size_t point = number.find('.');
  return point == std::string_view::npos ? 0 : static_cast<int>(number.size() - point - 1);
}

/// "12.5", "AC(12.5)", "IC(-3)" behind the '=' of a word. Any other value is an expression.
void read_siemens_value(Scanner& s, Word& word) {
  s.skip_blanks();
  Span value{s.at, s.at};
  skip_siemens_value(s);
  word.span.end = value.end = s.at;
  if (empty(value)) s.refuse_at(s.at - 1, fmt::format("{}= has no value", word.letter));
  const std::string_view text = part(s.text, value);
  const bool absolute = is_word(text.substr(0, 3), "AC("), relative = is_word(text.substr(0, 3), "IC(");
  if ((absolute || relative) && text.back() == ')') {
    value = {value.begin + 3, value.end - 1};
    word.mode = absolute ? DistanceMode::absolute : DistanceMode::relative;
    s.block.has_own_mode = true;
  }
  word.number = value;
  const auto number = plain_number(part(s.text, value));
  word.literal = number.has_value();
  word.value = number.value_or(0);
  word.point = part(s.text, value).find('.') != std::string_view::npos;
  word.decimals = decimals_in_plain(part(s.text, value));
}

}  // namespace

std::string_view siemens_name_at(const Scanner& s) {
  std::size_t end = s.at;
  while (end < s.end && is_name_character(s.text[end])) ++end;
  return s.text.substr(s.at, end - s.at);
}

void skip_siemens_rest(Scanner& s) {
  bool quoted = false;
  for (; s.at < s.end && (quoted || s.peek() != ';'); ++s.at)
    if (s.peek() == '"') quoted = !quoted;
}

void skip_siemens_value(Scanner& s) {
  const std::size_t begin = s.at;
  int depth = 0;
  bool complete = false;  // an operand or a bracket ends at the scanner
  while (s.at < s.end) {
    const char c = s.peek();
    if (depth <= 0 && (is_blank(c) || c == ';')) return;
    if (c == '"' || c == '\'') {
      skip_quoted(s);
      complete = true;
    } else if (!is_name_character(c)) {
      if (c == '(' || c == '[') ++depth;
      if (c == ')' || c == ']') --depth;
      complete = c == ')' || c == ']' || (c == '.' && complete);
      ++s.at;
    } else if (complete && depth <= 0 && !is_digit(c)) {
      const std::size_t size = size_of_operator(s);
      if (size == 0) return end_before_word(s, begin);
      s.at += size;
      complete = false;
    } else {
      s.at += size_of_operand(siemens_name_at(s));
      complete = true;
    }
  }
}

void skip_siemens_index(Scanner& s) {
  int depth = 0;
  do {
    if (s.peek() == '[') ++depth;
    if (s.peek() == ']') --depth;
    ++s.at;
  } while (depth > 0 && s.at < s.end);
}

void take_assigned(Scanner& s, Span variable) {
  const std::size_t value = ++s.at;
  skip_assigned(s);
  s.block.assignments.push_back({variable, {value, s.at}});
}

void take_speed_word(Scanner& s, std::size_t name_length) {
  SpeedWord& word = s.block.speed_words.emplace_back();
  word.name = {s.at, s.at + name_length};
  s.at = word.name.end;
  s.skip_blanks();
  if (s.peek() == '[') skip_siemens_index(s), s.skip_blanks();
  word.value.number = {s.at, s.at};
  if (s.peek() == '(') {
    word.value.number.begin = ++s.at;
    while (s.at < s.end && s.peek() != ')') ++s.at;
    word.value.number.end = s.at;
    if (s.at < s.end) ++s.at;
  } else if (s.peek() == '=') {
    word.value.number.begin = ++s.at;
    skip_assigned(s);
    word.value.number.end = s.at;
  }
  const auto number = plain_number(trimmed_text(part(s.text, word.value.number)));
  word.value.literal = number.has_value();
  word.value.value = number.value_or(0);
}

void read_named_word(Scanner& s, char letter, std::size_t name_length) {
  Word& word = s.block.words.emplace_back();
  word.letter = letter;
  word.span.begin = s.at;
  s.at += name_length;
  s.skip_blanks();
  ++s.at;
  read_siemens_value(s, word);
  if (letter == 'P') word.value += 1;
}

}  // namespace counterflex
