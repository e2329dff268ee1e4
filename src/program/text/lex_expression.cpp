#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr std::array<std::string_view, 7> macro_keywords{"IF",  "GOTO",  "WHILE", "DO",
                                                         "END", "DPRNT", "BPRNT"};
constexpr std::string_view then = "THEN";
constexpr std::array<std::string_view, 4> bare_keywords{"POPEN", "PCLOS", "SETVN", then};
constexpr std::array<std::string_view, 15> o_keywords{"SUB",    "ENDSUB", "CALL",      "RETURN", "IF",
                                                      "ELSEIF", "ELSE",   "ENDIF",     "WHILE",  "ENDWHILE",
                                                      "DO",     "REPEAT", "ENDREPEAT", "BREAK",  "CONTINUE"};

/// Letters that begin at `at`.
std::string_view letters_at(const Scanner& s, std::size_t at) {
  std::size_t stop = at;
  while (stop < s.end && is_letter(s.text[stop])) ++stop;
  return s.text.substr(at, stop - at);
}

void skip_bracket(Scanner& s) {
  const std::size_t open = s.at;
  int depth = 0;
  for (; s.at < s.end; ++s.at) {
    if (s.text[s.at] == '[') ++depth;
    if (s.text[s.at] == ']' && --depth == 0) {
      ++s.at;
      return;
    }
  }
  s.refuse_at(open, "'[' is not closed on its line");
}

/// "#5", "#<name>", "#[...]", "##2".
void skip_variable(Scanner& s) {
  const std::size_t begin = s.at;
  while (s.peek() == '#') ++s.at, s.skip_blanks();
  if (s.peek() == '[') return skip_bracket(s);
  if (s.peek() == '<') {
    const std::size_t close = s.text.substr(0, s.end).find('>', s.at);
    if (close == std::string_view::npos) s.refuse_at(s.at, "'<' is not closed on its line");
    s.at = close + 1;
    return;
  }
  if (!is_digit(s.peek())) s.refuse_at(begin, "'#' has no variable: a number, <name> or [...] must follow");
  while (is_digit(s.peek())) ++s.at;
}

/// A name, an operator, or a word: one letter before its value. THEN may be directly before a word.
void skip_letters_of_rest(Scanner& s) {
  std::string_view letters = letters_at(s, s.at);
  if (letters.size() > then.size() && is_word(letters.substr(0, then.size()), then))
    letters.remove_prefix(then.size());
  s.skip_letters();
  if (letters.size() == 1 && may_move(letters[0])) s.block.statement = Statement::not_read;
}

/// Skips text up to a comment, or to the ';' that ends a block. If it has axis words or G codes, the block is
/// not supported.
void skip_rest(Scanner& s) {
  while (s.at < s.end && s.text[s.at] != comment_open && s.text[s.at] != ';') {
    if (s.text[s.at] == '[') {
      skip_bracket(s);
    } else if (is_letter(s.text[s.at])) {
      skip_letters_of_rest(s);
    } else {
      ++s.at;
    }
  }
}

/// Skips text up to the next assignment, to a comment, or to the ';' that ends a block.
void skip_macro_value(Scanner& s) {
  const std::string_view line = s.text.substr(0, s.end);
  std::size_t next = line.find('=', s.at);
  if (next == std::string_view::npos) return skip_rest(s);
  while (next > s.at && s.text[next] != '#') --next;
  if (next == s.at) return skip_rest(s);
  Scanner value = s;
  value.end = next;
  skip_rest(value);
  s.at = value.at;
}

void skip_number(Scanner& s) {
  const std::size_t begin = s.at;
  if (s.peek() == '-' || s.peek() == '+') ++s.at;
  const std::size_t digits = s.at;
  while (is_digit(s.peek()) || s.peek() == '.') ++s.at;
  if (s.at == digits) s.refuse_at(begin, "'=' has no value");
}

void note_flow(Scanner& s, Span name, Span keyword) {
  s.block.flow_name = name;
  s.block.flow_keyword = keyword;
  s.at = keyword.end;
  skip_rest(s);
}

bool lex_o_word(Scanner& s) {
  Scanner ahead = s;
  ++ahead.at;
  ahead.skip_blanks();
  const std::size_t name = ahead.at;
  if (ahead.peek() == '<') {
    const std::size_t close = s.text.substr(0, s.end).find('>', ahead.at);
    if (close == std::string_view::npos) s.refuse_at(ahead.at, "'<' is not closed on its line");
    ahead.at = close + 1;
  } else if (ahead.peek() == '#' || ahead.peek() == '[') {
    skip_expression(ahead);
  } else {
    while (is_digit(ahead.peek())) ++ahead.at;
  }
  const Span named{name, ahead.at};
  ahead.skip_blanks();
  const std::string_view keyword = letters_at(ahead, ahead.at);
  if (keyword.empty()) {
    if (!empty(named) && is_digit(s.text[name])) return false;
    s.refuse_at(s.at, fmt::format("O{} has no keyword; use sub, call, if, while, ...", part(s.text, named)));
  }
  if (!is_one_of(keyword, o_keywords))
    s.refuse_at(ahead.at, fmt::format("unknown O-word keyword '{}'; use sub, call, if, while, ...", keyword));
  note_flow(s, named, {ahead.at, ahead.at + keyword.size()});
  return true;
}

/// Behind IF: a condition, and GOTO or THEN with the assignment of a variable. Other text may be a call, a
/// jump or a motion.
void lex_consequence(Scanner s, Block& block) {
  s.skip_blanks();
  if (s.peek() == '[') skip_bracket(s);
  s.skip_blanks();
  const std::string_view letters = letters_at(s, s.at);
  if (is_word(letters, "GOTO")) return;
  const bool sets = is_word(letters, then);
  s.at += letters.size();
  s.skip_blanks();
  if (!sets || s.peek() != '#') {
    block.statement = Statement::not_read;
    return;
  }
  const std::size_t begin = s.at;
  skip_variable(s);
  block.assignments.push_back({{begin, s.at}, {}});
}

bool lex_macro_word(Scanner& s) {
  const std::string_view word = letters_at(s, s.at);
  if (!is_one_of(word, macro_keywords) && !is_one_of(word, bare_keywords)) return false;
  const std::size_t after = s.at + word.size();
  Scanner behind = s;
  behind.at = after;
  note_flow(s, {after, after}, {s.at, after});
  if (is_word(word, "IF")) lex_consequence(behind, s.block);
  return true;
}

}  // namespace

std::string upper_case(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), upper);
  return result;
}

bool is_word(std::string_view text, std::string_view upper_case) {
  return std::equal(text.begin(), text.end(), upper_case.begin(), upper_case.end(),
                    [](char a, char b) { return upper(a) == b; });
}

bool at_expression(const Scanner& scanner) {
  Scanner s = scanner;
  if (s.peek() == '-' || s.peek() == '+') ++s.at, s.skip_blanks();
  if (s.peek() == '#' || s.peek() == '[') return true;
  const std::string_view name = letters_at(s, s.at);
  if (name.size() < 2) return false;
  s.at += name.size();
  s.skip_blanks();
  return s.peek() == '[';
}

void skip_expression(Scanner& s) {
  if (s.peek() == '-' || s.peek() == '+') ++s.at, s.skip_blanks();
  if (s.peek() == '#') return skip_variable(s);
  const bool two_brackets = is_word(letters_at(s, s.at), "ATAN");
  s.skip_letters();
  s.skip_blanks();
  skip_bracket(s);
  if (!two_brackets || s.peek() != '/') return;
  ++s.at;
  s.skip_blanks();
  if (s.peek() != '[') s.refuse_at(s.at, "ATAN[...]/ needs a second argument in [...]");
  skip_bracket(s);
}

void skip_assignment(Scanner& s) {
  s.block.assigns = true;
  const std::size_t begin = s.at;
  skip_variable(s);
  const Span variable{begin, s.at};
  s.skip_blanks();
  if (s.peek() != '=') s.refuse_at(s.at, "a variable at the beginning of a block needs '=' and a value");
  ++s.at;
  s.skip_blanks();
  if (s.at == s.end || s.peek() == comment_open) s.refuse_at(s.at - 1, "'=' has no value");
  const std::size_t value = s.at;
  if (s.dialect.macro_words)
    skip_macro_value(s);
  else if (at_expression(s))
    skip_expression(s);
  else
    skip_number(s);
  s.block.assignments.push_back({variable, {value, s.at}});
}

bool lex_flow(Scanner& s) {
  if (s.dialect.o_words && upper(s.peek()) == 'O') return lex_o_word(s);
  return s.dialect.macro_words && s.at + 1 < s.end && is_letter(s.text[s.at + 1]) && lex_macro_word(s);
}

}  // namespace counterflex
