#pragma once
/// Scanner of one line.
#include <algorithm>
#include <string>
#include <string_view>

#include "program/text/lex.hpp"

namespace counterflex {

inline bool is_blank(char c) {
  return c == ' ' || c == '\t';
}
/// Control characters of transmission and printing. They are ignored at both ends of a line.
inline bool is_ignored(char c) {
  return c == '\0' || c == '\r' || c == '\f' || c == '\v' || (c >= 0x11 && c <= 0x14) || c == 0x1a ||
         c == 0x7f;
}
/// Number of bytes of the UTF-8 byte order mark.
inline std::size_t byte_order_mark(std::string_view text) {
  constexpr std::string_view mark = "\xef\xbb\xbf";
  return text.starts_with(mark) ? mark.size() : 0;
}
inline bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
inline bool is_letter(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}
inline bool is_identifier_character(char c) {
  return is_letter(c) || is_digit(c) || c == '_';
}
/// Position of the first of two characters from `at` on, or npos.
inline std::size_t find_either(std::string_view text, char a, char b, std::size_t at) {
  while (at < text.size() && text[at] != a && text[at] != b) ++at;
  return at < text.size() ? at : std::string_view::npos;
}
inline char upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}
inline char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// Reads from `at` to `end`. They are not adjacent members: a load of both as one pair would wait for the
/// stores before it.
struct Scanner {
  std::size_t end;
  std::string_view text;
  const std::string& file;
  const Dialect& dialect;
  Block& block;
  std::size_t at;

  char peek() const { return at < end ? text[at] : '\0'; }
  void skip_blanks() {
    while (at < end && is_blank(text[at])) ++at;
  }
  void skip_letters() {
    while (at < end && is_letter(text[at])) ++at;
  }
  [[noreturn]] void refuse_at(std::size_t where, const std::string& message) const {
    refuse(file, block, where, message);
  }
};

/// Appends a letter with its number to the block. Throws `InputError` if it has no number.
void lex_word(Scanner& scanner);

/// Refuses the character at the scanner.
[[noreturn]] void refuse_character(const Scanner& scanner);

/// Whether a word with this letter can affect the path: axes, centres and radii, G codes.
inline bool may_move(char letter) {
  return std::string_view("ABCGIJKRUVWXYZ").find(upper(letter)) != std::string_view::npos;
}

std::string upper_case(std::string_view text);

/// Whether `text` is `upper_case`, ignoring case.
bool is_word(std::string_view text, std::string_view upper_case);

/// Whether `text` is one of `words`, which are in upper case.
template <typename Words>
bool is_one_of(std::string_view text, const Words& words) {
  return std::any_of(words.begin(), words.end(), [&](std::string_view word) { return is_word(text, word); });
}

/// Whether an expression begins at the scanner: a variable, an expression in brackets or a function, with or
/// without a sign.
bool at_expression(const Scanner& scanner);

/// Skips an expression. Throws `InputError` if it is incomplete.
void skip_expression(Scanner& scanner);

/// Skips `#1=...` or `#<name>=...`. Throws `InputError` if it is incomplete.
void skip_assignment(Scanner& scanner);

/// Skips a line of flow that begins here ("o100 sub", "IF [#1 GT 2] GOTO 10", "END1") and stores its name and
/// keyword in the block. False if there is no such line. Throws `InputError` if it is incomplete.
bool lex_flow(Scanner& scanner);

}  // namespace counterflex
