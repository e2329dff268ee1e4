#include <fmt/format.h>

#include <algorithm>

#include "counterflex/files/text.hpp"

namespace counterflex {
namespace {

/// The code point of a UTF-8 character of one to three bytes, 0 for any other.
unsigned code_of(std::string_view character) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(character[i]); };
  if (character.size() == 1) return byte(0);
  if (character.size() == 2) return (byte(0) & 0x1FU) << 6 | (byte(1) & 0x3FU);
  if (character.size() == 3) return (byte(0) & 0x0FU) << 12 | (byte(1) & 0x3FU) << 6 | (byte(2) & 0x3FU);
  return 0;
}

/// DEL, controls of C1, marks and overrides of direction, separators of lines and paragraphs.
bool is_control(unsigned code) {
  return (code >= 0x7F && code < 0xA0) || code == 0x061C || (code >= 0x200E && code <= 0x200F) ||
         (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
}

bool is_plain_ascii(char c) {
  return c >= 0x20 && c < 0x7f;
}

}  // namespace

std::string without_controls(std::string_view text) {
  std::string shown;
  if (std::all_of(text.begin(), text.end(), is_plain_ascii)) return shown.assign(text);
  while (!text.empty()) {
    const std::string_view character = first_character(text);
    const auto byte = static_cast<unsigned char>(character.front());
    if (byte == '\t')
      shown += ' ';
    else if (byte < 0x20)
      shown += fmt::format("\\x{:02X}", byte);
    else if (const unsigned code = code_of(character); is_control(code))
      shown += fmt::format("\\u{:04X}", code);
    else
      shown += character;
    text.remove_prefix(character.size());
  }
  return shown;
}

std::string lines_without_controls(std::string_view text) {
  std::string shown;
  for (;;) {
    const std::size_t end = text.find('\n');
    shown += without_controls(text.substr(0, end));
    if (end == std::string_view::npos) return shown;
    shown += '\n';
    text.remove_prefix(end + 1);
  }
}

}  // namespace counterflex
