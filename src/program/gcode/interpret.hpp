#pragma once
/// Follows the modal state of a program block by block and finds its moves.
#include <map>
#include <string>
#include <vector>

#include "counterflex/program/program.hpp"
#include "counterflex/program/read_program.hpp"
#include "program/text/lex.hpp"
#include "program/gcode/modal_state.hpp"
#include "program/text/operation.hpp"
#include "program/outline.hpp"
#include "program/gcode/words/sorted_block.hpp"
#include "program/evaluate/variables.hpp"

namespace counterflex {

/// The conditions, loops and subprograms around a block: what stands in them may run never or often.
struct Body {
  std::vector<std::string> open;  ///< of O-words: name and keyword; else the keyword
  ModalState before{};            ///< where the outermost was opened
  std::uint16_t doubts = 0;       ///< states that ways through the body leave different
  bool subprogram = false;        ///< the outermost is one: it does not run where it stands
  bool jumps = false;             ///< GOTO makes the whole program a body
};

/// What is needed to read one block after the other; `program` grows, and only moves of an unfinished contour
/// are looked at again.
struct Reading {
  const Dialect& dialect;
  const ReadOptions& options;
  std::array<bool, 3> tool_change_axes{};
  Program& program;
  const Outline& outline;
  ModalState state{};
  SortedBlock sorted{};
  std::optional<bool> block_relative{};  ///< X=IC(5), X=AC(5): for this block, whatever is modal
  std::uint8_t relative_axes = 0;        ///< X=IC(5) beside Y5: a bit for each axis whose word alone counts from the start
  Body body{};
  CurrentOperation operation{};
  int groups = 0;                    ///< contours begun
  std::array<bool, 3> taken_away{};  ///< axes that the machine has moved by itself since the last move
  std::size_t run_begin = 0;         ///< the first move since the tool went to a place of the machine
  std::size_t program_numbers = 0;   ///< lines that begin with an O-number, so far
  std::size_t turns = 0;             ///< of all arcs so far, one at least for each
  double turned_mm = 0;              ///< the way of their full turns
  std::map<std::string, SetOffset> offsets{};  ///< by name
  Variables variables{};  ///< whose values are known, see `evaluate_words`
  std::optional<Word> angle{};               ///< of the block's line, which says one of two coordinates
  std::optional<CalledCycle> called{};  ///< by MCALL, at every position
  std::string last_reason{};         ///< for which a block was left alone
  std::optional<CornerSize> corner{};        ///< that the block's end and the begin of the next make
  std::optional<CornerSize> after_corner{};  ///< that the last move and the next one make
  bool lengths_set = false;          ///< G10 has changed tool lengths: those of the options no longer hold
  bool after_subprogram = false;     ///< M99 has ended one: another program may follow
  bool ended = false;                ///< M2 or M30 was read

  bool relative() const { return block_relative.value_or(state.relative); }
  bool in_body() const { return body.jumps || !body.open.empty(); }
};

/// Adds what `block` says to `reading`. Throws `InputError` for what is wrong or not read yet.
void interpret(const Block& block, Reading& reading);

}  // namespace counterflex
