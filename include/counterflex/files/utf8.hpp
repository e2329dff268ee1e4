#pragma once
/// Characters of text that need not be UTF-8, as the names of files and the comments of programs.
#include <string>
#include <string_view>

namespace counterflex {

/// The character of UTF-8 at the beginning of `text`, which is not empty; its first byte, 0x80 or above,
/// where none begins there.
std::string_view first_character(std::string_view text);

/// Any bytes as UTF-8: a byte that is none is written as % and two hexadecimal digits, % itself as %25.
std::string utf8_of_bytes(std::string_view bytes);

/// The bytes that `utf8_of_bytes` was given, for what it writes.
std::string bytes_of_utf8(std::string_view text);

}  // namespace counterflex
