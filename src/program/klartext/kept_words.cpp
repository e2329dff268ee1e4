#include "program/klartext/kept_words.hpp"

#include <algorithm>
#include <string_view>

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

// Without the words L, LP, C, CP, CR and CT at the beginning, the sense DR of an arc and what is
// left of polar coordinates.
std::string without_klartext_motion(std::string text) {
  const std::size_t begin = !text.empty() && text[0] == '/' ? 1 : 0;
  for (const std::string_view key : {"PA", "PR"})
    drop_polar_word(text, key, std::min(text.find(';'), text.size()));
  for (const std::string_view head : {"CR", "CT", "CP", "C", "LP", "L"})
    if (std::string_view(text).substr(begin).starts_with(head)) {
      text.erase(begin, head.size());
      break;
    }
  const std::size_t comment = std::min(text.find(';'), text.size()), sense = text.find("DR");
  if (sense < comment) text.erase(sense, std::min<std::size_t>(3, comment - sense));
  return text;
}

}  // namespace

std::string klartext_kept_words(const Program& program, const Move& move) {
  return without_klartext_motion(without_klartext_number(without_rewritten_words(program, move, true)));
}

}  // namespace counterflex
