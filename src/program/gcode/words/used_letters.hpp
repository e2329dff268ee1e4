#pragma once
/// The letters that the codes of a block use. An unused word is an error.
#include <cstdint>
#include <string_view>

#include "program/gcode/words/sorted_block.hpp"

namespace counterflex {

/// A set of letters, A in the lowest bit.
using Letters = std::uint32_t;

constexpr Letters letter_bit(char letter) {
  return Letters{1} << (letter - 'A');
}

/// Letters with a meaning in a block with these codes. `context` is the active motion.
Letters used_letters(const SortedBlock& sorted, const Dialect& dialect, Context context);

}  // namespace counterflex
