#pragma once
/// Which letters the codes of a block use: a word that nothing uses is an error.
#include <cstdint>
#include <string_view>

#include "program/gcode/words/sorted_block.hpp"

namespace counterflex {

/// A set of letters, A in the lowest bit.
using Letters = std::uint32_t;

constexpr Letters letter_bit(char letter) {
  return Letters{1} << (letter - 'A');
}

/// Letters that mean something in a block with these codes, where `context` is the motion that acts.
Letters used_letters(const SortedBlock& sorted, const Dialect& dialect, Context context);

}  // namespace counterflex
