#pragma once
/// Follows the modal state of a program block by block and finds its moves.
#include <string>

#include "counterflex/program/program.hpp"
#include "counterflex/program/read_program.hpp"
#include "program/lex.hpp"
#include "program/modal_state.hpp"
#include "program/sorted_block.hpp"

namespace counterflex {

/// What is needed to read one block after the other; `program` grows, nothing else is kept of a block that is
/// past.
struct Reading {
  const Dialect& dialect;
  const ReadOptions& options;
  std::array<bool, 3> tool_change_axes{};
  Program& program;
  ModalState state{};
  SortedBlock sorted{};
  bool ended = false;  ///< M2 or M30 was read
};

/// Adds what `block` says to `reading`. Throws `InputError` for what is wrong or not read yet.
void interpret(const Block& block, Reading& reading);

}  // namespace counterflex
