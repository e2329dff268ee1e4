#include "program/robot/fanuc/kept_words.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include "program/robot/kept_words.hpp"

namespace counterflex {
namespace {

// The statement without the numbers of its lines and of its positions. A 'C' that became a line has
// one position.
std::string tp_statement(std::string_view block) {
  std::string text;
  for (std::size_t at = 0; at < block.size();) {
    const std::size_t end = std::min(block.find('\n', at), block.size());
    std::string_view line = block.substr(at, end - at);
    if (const std::size_t colon = line.find(':'); colon != std::string_view::npos)
      line.remove_prefix(colon + 1);
    text += without_spaces(line);
    at = end + 1;
  }
  std::erase(text, '\r');
  for (std::size_t at = 0; (at = text.find("P[", at)) != std::string::npos; at += 2) {
    const std::size_t close = std::min(text.find(']', at), text.size());
    text.erase(at + 2, close - at - 2);
  }
  constexpr std::string_view two = "CP[]P[]";
  if (text.starts_with(two)) text.replace(0, two.size(), "LP[]");
  return text;
}

}  // namespace

std::string tp_kept_words(const Program& program, const Move& move) {
  const std::vector<Span> numbers = target_numbers(move);
  const std::string& all = program.text;
  std::string text =
      tp_statement(std::string_view(all).substr(move.block.begin, move.block.end - move.block.begin));
  if (numbers.empty()) return text;
  std::size_t at = all.rfind('{', numbers.front().begin);
  if (at == std::string::npos) at = numbers.front().begin;
  const auto keep = [&](std::size_t end) {
    for (; at < end; ++at)
      if (std::string_view(" \t\r\n").find(all[at]) == std::string_view::npos) text += all[at];
  };
  for (const Span& number : numbers) {
    keep(number.begin);
    at = number.end;
  }
  keep(std::min(all.find('}', at), all.size()));
  return text;
}

}  // namespace counterflex
