#include "program/robot/fanuc/kept_words.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include "program/robot/fanuc/lex.hpp"
#include "program/robot/kept_words.hpp"
#include "program/text/lex.hpp"

namespace counterflex {
namespace {

// The statement in upper case, without the numbers of its lines and of its positions. A 'C' that became a
// line has one position.
std::string tp_statement(std::string_view block) {
  std::string text;
  for (std::size_t at = 0; at < block.size();) {
    const std::size_t end = std::min(block.find('\n', at), block.size());
    std::string_view line = block.substr(at, end - at);
    if (const std::size_t colon = line.find(':'); colon != std::string_view::npos)
      line.remove_prefix(colon + 1);
    text += tp_word(line);
    at = end + 1;
  }
  for (std::size_t at = 0; (at = text.find("P[", at)) != std::string::npos; at += 2) {
    const std::size_t close = std::min(text.find(']', at), text.size());
    text.erase(at + 2, close - at - 2);
  }
  constexpr std::string_view two = "CP[]P[]";
  if (text.starts_with(two)) text.replace(0, two.size(), "LP[]");
  return text;
}

// What the position with these numbers has besides them.
std::string tp_position(std::string_view text, const std::vector<Span>& numbers) {
  if (numbers.empty()) return {};
  const std::size_t open = text.rfind('{', numbers.front().begin);
  const std::size_t begin = open == std::string_view::npos ? numbers.front().begin : open;
  const std::size_t end = std::min(text.find('}', numbers.back().end), text.size());
  return words_without(text, {begin, end}, numbers);
}

}  // namespace

std::string tp_kept_words(const Program& program, const Move& move) {
  const std::string_view text = program.text;
  std::string words = tp_statement(part(text, move.block)) + tp_position(text, target_numbers(move));
  if (move.arc) words += auxiliary_mark + tp_position(text, auxiliary_numbers(move));
  return words;
}

}  // namespace counterflex
