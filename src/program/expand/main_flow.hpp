#pragma once
/// The flow of the program itself, between the definitions of subprograms in its text.
#include <optional>
#include <string>
#include <string_view>

#include "program/expand/definitions.hpp"

namespace counterflex {

/// A text, and the number of programs in it that have a number of their own.
struct ProgramText {
  std::string_view text;
  const std::string& file;
  const Dialect& dialect;
  std::ptrdiff_t numbered_programs = 0;
};

/// The definition that begins with `block`. A single program that ends with M99 repeats itself and is not a
/// definition.
std::optional<Definition> definition_at(const ProgramText& program, const Block& block);

struct MainFlow {
  ControlFlow flow{};
  bool any = false;     ///< it has loops, conditions or jumps
  std::size_t end = 0;  ///< end of its lines
};

/// The lines of flow of the program. Throws `UnknownFlow` if they cannot be executed.
MainFlow read_main_flow(const ProgramText& program);

/// Whether execution ends with the block, if no structure is open at it.
bool ends_main(const Block& block, const Dialect& dialect);

}  // namespace counterflex
