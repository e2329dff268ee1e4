#include "program/outline.hpp"

#include "program/scanner.hpp"
#include "program/siemens_lex.hpp"

namespace counterflex {
namespace {

/// Whether `at` stands in a comment of its line.
bool in_comment(std::string_view text, std::size_t at) {
  for (std::size_t i = at; i-- > 0 && text[i] != '\n';) {
    if (text[i] == comment_close) return false;
    if (text[i] == comment_open) return true;
  }
  return false;
}

/// Whether only blanks, '%' and digits of N stand before `at` on its line.
bool begins_line(std::string_view text, std::size_t at) {
  for (std::size_t i = at; i-- > 0 && text[i] != '\n';)
    if (!is_blank(text[i])) return false;
  return true;
}

enum class Ending { none, of_program, of_subprogram };

/// What the M at `at` ends.
Ending ending_at(std::string_view text, std::size_t at) {
  std::size_t i = at + 1;
  while (i < text.size() && is_blank(text[i])) ++i;
  int code = 0, digits = 0;
  for (; i < text.size() && is_digit(text[i]) && digits < 6; ++i, ++digits)
    code = code * 10 + (text[i] - '0');
  if (digits == 0 || in_comment(text, at)) return Ending::none;
  if (code == 99) return Ending::of_subprogram;
  return code == 2 || code == 30 ? Ending::of_program : Ending::none;
}

Ending first_ending(std::string_view text, std::size_t from) {
  for (std::size_t at = from; (at = text.find_first_of("Mm", at)) != std::string_view::npos; ++at)
    if (const Ending ending = ending_at(text, at); ending != Ending::none) return ending;
  return Ending::none;
}

bool goto_at(std::string_view text, std::size_t o) {
  return o > 0 && is_word(text.substr(o - 1, 4), "GOTO") && !in_comment(text, o);
}

void look_for(std::string_view text, char o, Outline& outline, std::vector<std::size_t>& numbers) {
  for (std::size_t at = 0; (at = text.find(o, at)) != std::string_view::npos; ++at) {
    if (goto_at(text, at)) outline.jumps = true;
    if (at + 1 < text.size() && is_digit(text[at + 1]) && begins_line(text, at)) numbers.push_back(at);
  }
}

}  // namespace

Outline outline_of(std::string_view text, const Dialect& dialect) {
  Outline outline;
  if (dialect.sinumerik_words) outline.jumps = siemens_jumps(text);
  if ((dialect.family & (shop_families | mach3_family)) == 0) return outline;
  std::vector<std::size_t> numbers;
  look_for(text, 'O', outline, numbers);
  look_for(text, 'o', outline, numbers);
  // A single program that ends with M99 runs over and over: it is no subprogram.
  if (numbers.size() < 2) return outline;
  for (const std::size_t at : numbers)
    if (first_ending(text, at) == Ending::of_subprogram) outline.subprograms.push_back(at);
  return outline;
}

}  // namespace counterflex
