#pragma once
/// The first byte of an input chooses how the program after it is read, so that one target reaches all
/// dialects.
#include <cstdint>

#include "counterflex/program/read_program.hpp"

namespace counterflex::fuzz {

inline ReadOptions options_of(std::uint8_t first) {
  static const char* const dialects[] = {"auto", "linuxcnc", "grbl",    "fanuc",
                                         "haas", "mach3",    "siemens", "heidenhain"};
  ReadOptions options;
  options.dialect = dialects[first % 8];
  options.unit = first & 0x20 ? LengthUnit::inches : LengthUnit::millimetres;
  options.integer_words = static_cast<IntegerWords>((first >> 6) % 3);
  options.evaluate = first & 0x40;
  options.absolute_centres = first & 0x80;
  options.expand_subprograms = first & 0x08;
  if (first & 0x10) options.tool_change_moves.emplace();
  return options;
}

}  // namespace counterflex::fuzz
