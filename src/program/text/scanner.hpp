#pragma once
/// One line that is being taken apart.
#include <string>
#include <string_view>

#include "program/text/lex.hpp"

namespace counterflex {

inline bool is_blank(char c) {
  return c == ' ' || c == '\t';
}
/// Characters of transmissions and of printing: they mean nothing at the edges of a line.
inline bool says_nothing(char c) {
  return c == '\0' || c == '\r' || c == '\f' || c == '\v' || (c >= 0x11 && c <= 0x14) || c == 0x1a ||
         c == 0x7f;
}
/// Bytes of the mark with which editors begin UTF-8.
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
/// Where the first of two characters stands from `at` on, or npos.
inline std::size_t find_either(std::string_view text, char a, char b, std::size_t at) {
  while (at < text.size() && text[at] != a && text[at] != b) ++at;
  return at < text.size() ? at : std::string_view::npos;
}
inline char upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

/// Reads from `at` to `end`, which do not stand side by side: read as one pair from the block, where they
/// have just been stored, they would be waited for.
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

/// Takes a letter with its number into the block. Throws `InputError` where it has none.
void lex_word(Scanner& scanner);

/// Refuses the character at the scanner.
[[noreturn]] void refuse_character(const Scanner& scanner);

/// Whether a word with this letter can say where the tool goes: axes, centres and radii, G codes.
inline bool may_move(char letter) {
  return std::string_view("ABCGIJKRUVWXYZ").find(upper(letter)) != std::string_view::npos;
}

/// Whether `text` is `upper_case` in any case.
bool is_word(std::string_view text, std::string_view upper_case);

/// Whether a value that only the control can work out begins at the scanner: a variable, an expression in
/// brackets or a function, with or without a sign.
bool at_expression(const Scanner& scanner);

/// Passes over such a value. Throws `InputError` where it is cut short.
void skip_expression(Scanner& scanner);

/// Passes over `#1=...` or `#<name>=...`. Throws `InputError` where it is cut short.
void skip_assignment(Scanner& scanner);

/// Passes over a line of flow that begins here ("o100 sub", "IF [#1 GT 2] GOTO 10", "END1"), noting its name
/// and keyword in the block; false where none does. Throws `InputError` where it is cut short.
bool lex_flow(Scanner& scanner);

}  // namespace counterflex
