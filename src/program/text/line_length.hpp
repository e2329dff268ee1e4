#pragma once
/// Length of a line as the control counts it.
#include <string_view>

#include "program/dialect.hpp"

namespace counterflex {

/// Space that an inserted word or two may need.
inline constexpr std::size_t room_for_words = 10;

/// Characters of `line` that count towards `dialect.line_limit`.
inline std::size_t counted_length(const Dialect& dialect, std::string_view line) {
  if (dialect.limit_counts_comments) return line.size();
  std::size_t length = 0;
  bool comment = false;
  for (const char c : line) {
    if (c == ';' && !comment) break;
    if (c == comment_open) comment = true;
    if (!comment && c != ' ' && c != '\t') ++length;
    if (c == comment_close) comment = false;
  }
  return length;
}

}  // namespace counterflex
