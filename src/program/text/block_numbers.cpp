#include <algorithm>

#include "counterflex/program/rewrite.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr std::uint32_t four_digits = 9999, five_digits = 99999;  // limits of controls
constexpr std::uint32_t largest = 999999999;

/// Whether only blanks, '/' and its digit are before byte `at` of its line.
bool is_first_in_line(std::string_view text, std::size_t at) {
  while (at > 0 && text[at - 1] != '\n') {
    const char c = text[--at];
    const bool of_switch = is_digit(c) && at > 0 && text[at - 1] == '/';
    if (!is_blank(c) && c != '/' && !of_switch) return false;
  }
  return true;
}

}  // namespace

void BlockNumbers::add(std::string_view lines) {
  for (std::size_t at = lines.find_first_of("Nn"); at != std::string_view::npos;
       at = lines.find_first_of("Nn", at + 1)) {
    std::size_t digit = at + 1;
    while (digit < lines.size() && is_blank(lines[digit])) ++digit;
    std::uint32_t number = 0;
    const std::size_t begin = digit;
    for (; digit < lines.size() && is_digit(lines[digit]) && number < largest; ++digit)
      number = number * 10 + static_cast<std::uint32_t>(lines[digit] - '0');
    if (digit == begin || number >= largest) continue;
    used_.push_back(number);
    if (is_first_in_line(lines, at)) repeated_.push_back(number);
  }
}

void BlockNumbers::finish() {
  std::sort(used_.begin(), used_.end());
  used_.erase(std::unique(used_.begin(), used_.end()), used_.end());
  std::sort(repeated_.begin(), repeated_.end());
  std::vector<std::uint32_t> repeated;
  for (std::size_t i = 1; i < repeated_.size(); ++i)
    if (repeated_[i] == repeated_[i - 1]) repeated.push_back(repeated_[i]);
  repeated_ = std::move(repeated);
}

bool BlockNumbers::has_room_after(long number, std::size_t count) const {
  if (number < 0 || number >= largest || count > five_digits) return false;
  const auto own = static_cast<std::uint32_t>(number);
  if (std::binary_search(repeated_.begin(), repeated_.end(), own)) return false;
  const std::uint32_t limit =
      used_.empty() || used_.back() <= four_digits ? four_digits : std::max(used_.back(), five_digits);
  const auto next = std::upper_bound(used_.begin(), used_.end(), own);
  const std::uint32_t end = next == used_.end() ? limit + 1 : *next;
  return own + count < end;
}

}  // namespace counterflex
