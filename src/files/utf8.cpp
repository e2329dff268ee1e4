#include <algorithm>

#include "counterflex/files/text.hpp"

namespace counterflex {
namespace {

/// The number of bytes of the character at the beginning of `text`, from its first byte; 0 if that byte is
/// invalid.
std::size_t utf8_length(std::string_view text) {
  const auto byte = static_cast<unsigned char>(text.front());
  if (byte < 0x80) return 1;
  if (byte >= 0xC2 && byte < 0xE0) return 2;
  if (byte >= 0xE0 && byte < 0xF0) return 3;
  return byte >= 0xF0 && byte < 0xF5 ? 4 : 0;
}

/// Refuses overlong forms, surrogates and values beyond U+10FFFF.
bool allowed_second_byte(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]),
             second = static_cast<unsigned char>(character[1]);
  if (first == 0xE0) return second >= 0xA0;
  if (first == 0xED) return second < 0xA0;
  if (first == 0xF0) return second >= 0x90;
  return first != 0xF4 || second < 0x90;
}

}  // namespace

std::string_view first_character(std::string_view text) {
  const std::size_t length = utf8_length(text);
  if (length <= 1 || text.size() < length) return text.substr(0, 1);
  const std::string_view rest = text.substr(1, length - 1);
  const bool whole = std::all_of(rest.begin(), rest.end(),
                                 [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; });
  return text.substr(0, whole && allowed_second_byte(text) ? length : 1);
}

}  // namespace counterflex
