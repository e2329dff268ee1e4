#include "program/write/kept_words.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <span>
#include <string_view>

#include "counterflex/files/input_error.hpp"
#include "program/expand/expand.hpp"
#include "program/text/scanner.hpp"
#include "program/write/block.hpp"

namespace counterflex {
namespace {

// Whether it is a word of one axis: a polar word gives two.
bool is_height(const Move& move, const PackedAxisWord& word) {
  std::size_t axes = 0;
  for (const auto& other : move.words) axes += word && other && other->number.begin == word->number.begin;
  return axes == 1;
}

// In their order in the text. A move has all of its words at most.
struct RewrittenNumbers {
  std::array<Span, 3 + 4 + 4 + 3 + 1 + 2> all;  // axes, heights, orientation, centre, radius, cycle
  std::size_t count = 0;

  std::span<const Span> in_order() {
    const auto numbers = std::span(all).first(count);
    std::ranges::sort(numbers, {}, &Span::begin);
    return numbers;
  }
};

RewrittenNumbers rewritten_numbers(const Move& move) {
  RewrittenNumbers numbers;
  const auto add = [&](const PackedAxisWord& word) {
    // A block may also have words of one before it: the centre or the surface that it uses.
    if (word && word->number.begin >= move.block.begin) numbers.all[numbers.count++] = word->number;
  };
  for (std::size_t axis = 0; axis < (move.called ? 2 : 3); ++axis)
    if (!move.polar || is_height(move, move.words[axis])) add(move.words[axis]);
  if (move.called && move.called->modal.empty())
    for (const auto& height : move.called->heights) add(height);
  if (move.orientation)
    for (const auto& word : move.orientation->words) add(word);
  if (move.arc) {
    for (const auto& word : move.arc->centre_words) add(word);
    add(move.arc->radius_word);
  }
  if (move.cycle) {
    add(move.cycle->bottom_word);
    add(move.cycle->retract_word);
  }
  return numbers;
}

void drop_name(std::string& text) {
  while (!text.empty() && std::isalpha(static_cast<unsigned char>(text.back())) != 0) text.pop_back();
}

// Takes the letter off with which a word begins, or its name and sign of equality, with the AC( or IC( of
// Sinumerik. True where a bracket has been taken off.
bool drop_letter(std::string& text, bool klartext) {
  if (text.empty()) return false;
  const bool bracket = text.back() == '(';
  if (bracket) text.pop_back(), drop_name(text);
  const bool named = !text.empty() && text.back() == '=';
  if (!text.empty()) text.pop_back();
  if (klartext && !text.empty() && upper(text.back()) == 'I') text.pop_back();
  if (named) drop_name(text);
  return bracket;
}

// The end of a word of motion (G0 to G3, with zeros before the digit) at `i`; `i` if it is missing.
std::size_t motion_word_end(const std::string& text, std::size_t i) {
  if (upper(text[i]) != 'G') return i;
  std::size_t end = i + 1;
  while (end + 1 < text.size() && text[end] == '0' && is_digit(text[end + 1])) ++end;
  if (end >= text.size() || text[end] < '0' || text[end] > '3') return i;
  const bool goes_on = end + 1 < text.size() && (is_digit(text[end + 1]) || text[end + 1] == '.');
  return goes_on ? i : end + 1;
}

// The end of a word of that letter or name at `i`; `i` if it is missing.
std::size_t word_end(const std::string& text, std::size_t i, std::string_view name) {
  for (std::size_t k = 0; k < name.size(); ++k)
    if (i + k >= text.size() || upper(text[i + k]) != name[k]) return i;
  return std::min(text.find_first_not_of("0123456789.", i + name.size()), text.size());
}

// Without words of motion, and without those that `names` gives.
std::string without_motion(const std::string& text, std::span<const std::string_view> names) {
  std::string kept;
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == ';') return kept + text.substr(i);
    std::size_t end = text[i] == '(' ? std::min(text.find(')', i), text.size() - 1) + 1 : i;
    kept.append(text, i, end - i);
    if (end > i) {
      i = end;
      continue;
    }
    end = motion_word_end(text, i);
    for (const std::string_view name : names)
      if (end == i) end = word_end(text, i, name);
    if (end == i) kept += text[end++];
    i = end;
  }
  return kept;
}

// "G2" or "G3", the last one of the block; empty without them.
std::string arc_word_of(const Block& block) {
  std::string word;
  for (const Word& w : block.words)
    if (is_motion(w)) word = w.value == 2 ? "G2" : w.value == 3 ? "G3" : "";
  return word;
}

// Empty where the text is not G-code, as behind the end of the program.
std::optional<Block> block_at(const Program& program, Span line) {
  Block block;
  block.span = line;
  try {
    lex(program.text, program.file, *find_dialect(program.dialect), block);
  } catch (const InputError&) {
    return std::nullopt;
  }
  return block;
}

}  // namespace

std::string without_rewritten_words(const Program& program, const Move& move, bool klartext) {
  std::string text;
  std::size_t at = move.block.begin;
  const auto keep = [&](std::size_t end) {
    for (; at < end; ++at)
      if (program.text[at] != ' ' && program.text[at] != '\t') text += program.text[at];
  };
  // CYCLE81(50,0,2,-20)
  const bool arguments = move.called && move.called->heights[0] && move.called->modal.empty();
  RewrittenNumbers numbers = rewritten_numbers(move);
  for (const Span& number : numbers.in_order()) {
    keep(number.begin);
    const bool bracket = !arguments && drop_letter(text, klartext);
    at = number.end;
    if (bracket) at = program.text.find(')', at) + 1;
  }
  keep(move.block.end);
  return text;
}

void follow_arc_word(const Program& program, Span line, std::string& word) {
  const bool may_set = part(program.text, line).find_first_of("Gg") != std::string_view::npos;
  if ((word.empty() && !may_set) || is_unused(program.expansion, line.begin)) return;
  const std::optional<Block> block = block_at(program, line);
  if (block && ends_motion(*block, *find_dialect(program.dialect))) word = arc_word_of(*block);
}

std::string take_arc_word(const Program& program, const Move& move, std::string& word) {
  const bool followed = move.handling != Handling::held && !any_axis(move.fixed);
  if (move.arc || followed) {
    word = !move.arc ? "" : move.arc->clockwise ? "G2" : "G3";
    return {};
  }
  const std::optional<Block> block = block_at(program, move.block);
  if (!block) return {};
  const Dialect& dialect = *find_dialect(program.dialect);
  const bool states = std::any_of(block->words.begin(), block->words.end(),
                                  [&](const Word& w) { return is_motion_word(w, dialect); });
  const std::string acting = states ? arc_word_of(*block) : word;
  if (ends_motion(*block, dialect)) word = acting;
  return move.motion == Motion::feed && !move.cycle ? acting : "";
}

std::string gcode_kept_words(const Program& program, const Move& move) {
  constexpr std::array<std::string_view, 4> names{"F", "N", "P", "TURN="};
  const bool angles = move.orientation && move.orientation->by_angles && move.motion == Motion::feed;
  const bool judges_feed = move.feed_mode == FeedMode::inverse_time || (angles && move.feed_mm_min > 0);
  const std::size_t begin = judges_feed ? 0 : 1, end = move.arc ? 4 : 2;
  return without_motion(without_rewritten_words(program, move, false),
                        std::span(names).subspan(begin, end - begin));
}

}  // namespace counterflex
