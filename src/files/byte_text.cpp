#include <fmt/format.h>

#include <charconv>

#include "counterflex/files/text.hpp"

namespace counterflex {

std::string utf8_of_bytes(std::string_view bytes) {
  std::string text;
  while (!bytes.empty()) {
    const std::string_view character = first_character(bytes);
    const auto byte = static_cast<unsigned char>(character.front());
    if (character == "%" || (character.size() == 1 && byte >= 0x80))
      text += fmt::format("%{:02X}", byte);
    else
      text += character;
    bytes.remove_prefix(character.size());
  }
  return text;
}

std::string bytes_of_utf8(std::string_view text) {
  std::string bytes;
  for (std::size_t at = 0; at < text.size();) {
    unsigned value = 0;
    const char* digits = text.data() + at + 1;
    const bool escaped = text[at] == '%' && at + 2 < text.size() &&
                         std::from_chars(digits, digits + 2, value, 16).ptr == digits + 2;
    bytes += escaped ? static_cast<char>(value) : text[at];
    at += escaped ? 3 : 1;
  }
  return bytes;
}

}  // namespace counterflex
