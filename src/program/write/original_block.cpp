#include "program/write/original_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/gcode/words/codes.hpp"
#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {

bool is_angle(const Word& word) {
  return word.letter >= 'A' && word.letter <= 'C';
}

bool is_axis(const Word& word) {
  return word.letter >= 'X' && word.letter <= 'Z';
}
bool is_centre(const Word& word) {
  return (word.letter >= 'I' && word.letter <= 'K') || word.letter == 'R';
}
bool is_motion(const Word& word) {
  return word.letter == 'G' && word.literal &&
         (word.value == 0 || word.value == 1 || word.value == 2 || word.value == 3);
}
bool is_motion_word(const Word& word, const Dialect& dialect) {
  if (word.letter != 'G' || !word.literal) return false;
  const GCode* code = find_g_code(static_cast<int>(std::lround(word.value * 10)), dialect);
  return is_motion(word) || (code != nullptr && code->group == CodeGroup::motion);
}

const Word* find_word(const Block& block, char upper) {
  const auto found =
      std::find_if(block.words.begin(), block.words.end(), [&](auto& w) { return w.letter == upper; });
  return found == block.words.end() ? nullptr : &*found;
}

namespace {

bool is_lower(char c) {
  return c >= 'a' && c <= 'z';
}

/// The last axis word; without axis words the last word; nullptr if there is no word.
const Word* word_that_shows_style(const Block& block) {
  const auto last = std::find_if(block.words.rbegin(), block.words.rend(), is_axis);
  if (last != block.words.rend()) return &*last;
  return block.words.empty() ? nullptr : &block.words.back();
}

/// The text before that word, if it is blanks or nothing behind another word.
std::string separator_of(const Original& o, const std::string& otherwise) {
  const Word* last = word_that_shows_style(o.block);
  if (last == nullptr || last == o.block.words.data()) return otherwise;
  const std::string_view gap = o.text({(last - 1)->span.end, last->span.begin});
  if (gap.find_first_not_of(" \t") != std::string_view::npos) return otherwise;
  return std::string(is_axis(*(last - 1)) ? gap : gap.substr(0, 1));
}

/// Whether the block has a word with '=', as "CR=10" or "I=AC(5)". Its pieces have such words, too.
bool has_equals_sign(const Original& o) {
  return std::ranges::any_of(
      o.block.words, [&](const Word& word) { return o.text(word.span).find('=') != std::string_view::npos; });
}

/// `number` of a G0 to G3 changed to `motion`, with its leading zero.
std::string motion_number(std::string_view number, int motion) {
  const bool two_digits = number.size() == 2 && number.front() == '0';
  return fmt::format("{}{}", two_digits ? "0" : "", motion);
}

}  // namespace

Original lex_again(const Program& program, const Move& move, const ProgramStyle& style) {
  Original o{program, *find_dialect(program.dialect), move};
  o.block.line = move.line;
  o.block.span = move.block;
  lex(program.text, program.file, o.dialect, o.block);
  const std::size_t newline = program.text.find('\n', move.block.end);
  o.line_end = newline == std::string::npos
                   ? style.line_end
                   : program.text.substr(move.block.end, newline + 1 - move.block.end);
  o.separator = separator_of(o, style.separator);
  if (o.separator.empty() && has_equals_sign(o)) o.separator = " ";
  const Word* shown = word_that_shows_style(o.block);
  o.lower_case = shown != nullptr && is_lower(program.text[shown->span.begin]);
  return o;
}

char letter_of(const Original& o, char upper) {
  return o.lower_case ? lower(upper) : upper;
}

std::string motion_text(const Original& o, int motion) {
  const auto word = std::find_if(o.block.words.begin(), o.block.words.end(), is_motion);
  if (word == o.block.words.end()) return fmt::format("{}{}", letter_of(o, 'G'), motion);
  if (word->value == motion) return std::string(o.text(word->span));
  return std::string(o.text({word->span.begin, word->number.begin})) +
         motion_number(o.text(word->number), motion);
}

std::string feed_text(const Original& o) {
  const Word* feed = find_word(o.block, 'F');
  const auto is_unit = [](const Word& w) { return w.letter == 'G' && (w.value == 20 || w.value == 21); };
  const bool other_unit = o.dialect.feed_before_unit && std::ranges::any_of(o.block.words, is_unit);
  const bool copied = feed != nullptr && o.move.motion == Motion::feed && !other_unit;
  return copied ? std::string(o.text(feed->span)) : std::string();
}

std::string block_delete_text(const Original& o) {
  Span span = o.block.block_delete;
  if (empty(span)) return {};
  while (span.end < o.block.span.end && o.program.text[span.end] == ' ') ++span.end;
  return std::string(o.text(span));
}

bool ends_in_semicolon(const Original& o) {
  return !o.dialect.semicolon_comments && o.text(o.block.span).find(';') != std::string_view::npos;
}

ProgramStyle style_of(const Program& program) {
  ProgramStyle style{" ", "\n"};
  const std::size_t newline = program.text.find('\n');
  if (newline != std::string::npos && newline > 0 && program.text[newline - 1] == '\r')
    style.line_end = "\r\n";
  for (const Move& move : program.moves) {
    if (!move.words[0] || !move.words[1] || move.words[1]->number.begin < move.words[0]->number.end) continue;
    const std::size_t begin = move.words[0]->number.end;
    const std::string_view gap = part(program.text, {begin, move.words[1]->number.begin});
    const std::size_t letter = gap.find_first_of("Yy");
    if (letter != std::string_view::npos && gap.find_first_not_of(" \t") == letter) {
      style.separator = gap.substr(0, letter);
      break;
    }
  }
  return style;
}

}  // namespace counterflex
