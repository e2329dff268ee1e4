#include "program/klartext/kept_words.hpp"

#include <algorithm>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"
#include "program/write/kept_words.hpp"

namespace counterflex {
namespace {

// Without the number of the block, which correction may move to another one.
std::string without_klartext_number(const std::string& text) {
  const std::size_t begin = !text.empty() && text[0] == '/' ? 1 : 0;
  std::size_t end = begin;
  if (end + 1 < text.size() && upper(text[end]) == 'N' && is_digit(text[end + 1])) ++end;
  while (end < text.size() && is_digit(text[end])) ++end;
  return text.substr(0, begin) + text.substr(end);
}

// Takes the word that begins with `key` out of `text` before `end`.
void drop_polar_word(std::string& text, std::string_view key, std::size_t end) {
  std::size_t begin = text.find(key);
  if (begin >= end) return;
  const std::size_t behind =
      std::min(text.find_first_not_of("+-0123456789.,", begin + key.size()), text.size());
  if (begin > 0 && text[begin - 1] == 'I') --begin;
  text.erase(begin, behind - begin);
}

// Removes the first of `heads` with which the statement begins.
void drop_head(std::string& text, std::initializer_list<std::string_view> heads) {
  const std::size_t begin = !text.empty() && text[0] == '/' ? 1 : 0;
  for (const std::string_view head : heads)
    if (std::string_view(text).substr(begin).starts_with(head)) {
      text.erase(begin, head.size());
      return;
    }
}

// Without the words L, LP, C, CP, CR and CT at the beginning, the sense DR of an arc and what is
// left of polar coordinates, where the move has the path that they describe.
std::string without_klartext_motion(std::string text, const Move& move) {
  if (move.polar)
    for (const std::string_view key : {"PA", "PR"})
      drop_polar_word(text, key, std::min(text.find(';'), text.size()));
  drop_head(text, {move.polar ? "LP" : "L", "L"});
  if (!move.arc) return text;
  drop_head(text, {"CR", "CT", "CP", "C"});
  const std::size_t comment = std::min(text.find(';'), text.size()), sense = text.find("DR");
  if (sense < comment) text.erase(sense, std::min<std::size_t>(3, comment - sense));
  return text;
}

// The statement of a line, behind the number of its block.
std::string_view statement_of_line(std::string_view line) {
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  const std::size_t digits = line.starts_with('N') || line.starts_with('n') ? 1 : 0;
  if (digits < line.size() && is_digit(line[digits])) line.remove_prefix(digits);
  line.remove_prefix(std::min(line.find_first_not_of(" \t0123456789"), line.size()));
  return line;
}

// The letters at the beginning of a statement, in upper case.
std::string head_of(std::string_view statement) {
  std::string head;
  for (std::size_t i = 0; i < statement.size() && is_letter(statement[i]); ++i) head += upper(statement[i]);
  return head;
}

bool sets_pole(std::string_view statement) {
  return head_of(statement) == "CC";
}

}  // namespace

std::string klartext_kept_words(const Program& program, const Move& move) {
  return without_klartext_motion(without_klartext_number(without_rewritten_words(program, move, true)), move);
}

std::string klartext_line_kept_words(std::string_view line) {
  const std::string_view statement = statement_of_line(line);
  return sets_pole(statement) ? "" : std::string(statement);
}

std::string klartext_pole_behind(std::string_view line, std::string before) {
  const std::string_view statement = statement_of_line(line);
  return sets_pole(statement) ? std::string(statement) : std::move(before);
}

bool needs_klartext_pole(std::string_view text, const Move& move) {
  if (move.arc || move.polar) return false;
  const std::string_view block = part(text, move.block);
  const std::size_t begin = std::min(block.find_first_not_of(" \t/Nn0123456789"), block.size());
  const std::string head = head_of(block.substr(begin));
  return head == "C" || head == "CP" || head == "LP";
}

}  // namespace counterflex
