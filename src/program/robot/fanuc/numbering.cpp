#include "program/robot/fanuc/numbering.hpp"

#include <algorithm>
#include <cctype>
#include <vector>

#include "program/robot/fanuc/positions.hpp"
#include "program/robot/writer.hpp"
#include "program/text/lex.hpp"
#include "program/text/operation.hpp"

namespace counterflex {
namespace {

// The shortest limit that is known of controls; no manual was at hand to confirm it.
constexpr std::size_t longest_remark = 32;
constexpr std::string_view mark = "COUNTERFLEX 1";

/// The digits of `number` in the place of `old`, with the blanks before it that keep the width.
TextChange renumbered(std::string_view text, std::size_t line_begin, Span old, long number) {
  std::string digits = std::to_string(number);
  Span place = old;
  while (place.begin > line_begin && text[place.begin - 1] == ' ' && place.end - place.begin < digits.size())
    --place.begin;
  if (digits.size() < place.end - place.begin)
    digits = std::string(place.end - place.begin - digits.size(), ' ').append(digits);
  return {place, std::move(digits)};
}

bool is_hash(std::string_view word) {
  constexpr std::size_t shortest = 16;
  return word.size() >= shortest &&
         std::ranges::all_of(word, [](unsigned char c) { return std::isxdigit(c) != 0; });
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t end = std::min(line.find(' ', at), line.size());
    if (end > at) words.push_back(line.substr(at, end - at));
    at = end + 1;
  }
  return words;
}

}  // namespace

std::string with_numbered_lines(std::string text, bool counts) {
  std::vector<TextChange> changes;
  RobotLine line;
  long number = 0;
  std::optional<Span> count;
  for (TpSection section = TpSection::attributes; next_tp_line(text, section, line);) {
    if (const auto next = tp_section(part(text, line.span))) {
      section = *next;
      if (section == TpSection::positions || section == TpSection::end) break;
    } else if (section == TpSection::attributes) {
      if (const auto found = line_count_in(text, line.span)) count = found;
    } else if (const auto field = tp_line_number(text, line.span); field && !empty(field->digits)) {
      changes.push_back(renumbered(text, line.span.begin, field->digits, ++number));
    }
  }
  if (counts && count) changes.push_back({*count, std::to_string(number)});
  return with_changes(text, {0, text.size()}, changes);
}

std::string tp_remarks(std::string_view line, std::string_view line_end) {
  if (line.starts_with(mark)) line.remove_prefix(mark.size());
  std::vector<std::string> remarks{std::string(mark)};
  const auto room = [&] { return longest_remark - remarks.back().size(); };
  for (std::string_view word : words_of(line)) {
    constexpr std::size_t least_digits = 8;
    const bool shortened = is_hash(word) && room() > least_digits;
    if (shortened) word = word.substr(0, std::min(word.size(), room() - 1));
    if (word.size() >= room() && remarks.back() != mark) remarks.emplace_back(mark);
    for (; word.size() >= room(); remarks.emplace_back(mark)) {
      const std::size_t size = room() - 1;
      remarks.back().append(" ").append(word.substr(0, size));
      word.remove_prefix(size);
      if (word.empty()) break;
    }
    if (!word.empty()) remarks.back().append(" ").append(word);
  }
  std::string text;
  for (const std::string& remark : remarks)
    if (remark != mark || remarks.size() == 1)
      text.append("   1:  !").append(remark).append(" ;").append(line_end);
  return text;
}

}  // namespace counterflex
