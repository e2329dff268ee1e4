#include "program/klartext/write/style.hpp"

#include <algorithm>
#include <string_view>

#include "program/text/lex.hpp"
#include "program/text/number_style.hpp"

namespace counterflex {
namespace {

bool begins_with_n(std::string_view block) {
  const std::size_t at = block.find_first_not_of(" \t/");
  return at != std::string_view::npos && (block[at] == 'N' || block[at] == 'n');
}

}  // namespace

std::string klartext_number(const KlartextStyle& style, double value, int decimals) {
  std::string text = inserted_number(value, decimals);
  if (style.comma) std::replace(text.begin(), text.end(), '.', ',');
  if (style.plus && text.front() != '-') text.insert(text.begin(), '+');
  return text;
}

KlartextStyle klartext_style(const Program& program) {
  KlartextStyle style;
  const std::size_t newline = program.text.find('\n');
  if (newline != std::string::npos && newline > 0 && program.text[newline - 1] == '\r')
    style.line_end = "\r\n";
  bool decided = false;
  for (const Move& move : program.moves) {
    style.numbered = style.numbered || move.block_number;
    style.n_words = style.n_words || begins_with_n(part(program.text, move.block));
    const auto look_at = [&](const PackedAxisWord& word) {
      if (!word || decided) return;
      const std::string_view number = part(program.text, word->number);
      style.plus = style.plus || number.starts_with('+');
      style.comma = number.find(',') != std::string_view::npos;
      decided = number.find_first_of(".,") != std::string_view::npos;
    };
    for (const auto& word : move.words) look_at(word);
    if (!move.arc) continue;
    for (const auto& word : move.arc->centre_words) look_at(word);
  }
  return style;
}

}  // namespace counterflex
