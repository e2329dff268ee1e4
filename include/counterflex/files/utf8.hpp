#pragma once
/// Characters of text that need not be UTF-8, as the names of files and the comments of programs.
#include <string_view>

namespace counterflex {

/// The character of UTF-8 at the beginning of `text`, which is not empty; its first byte, 0x80 or above,
/// where none begins there.
std::string_view first_character(std::string_view text);

}  // namespace counterflex
