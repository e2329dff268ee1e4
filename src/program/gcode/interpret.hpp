#pragma once
/// Follows the modal state of a program block by block and finds its moves.
#include <map>
#include <string>
#include <vector>

#include "counterflex/program/program.hpp"
#include "counterflex/program/read_program.hpp"
#include "program/evaluate/variables.hpp"
#include "program/gcode/modal_state.hpp"
#include "program/gcode/words/sorted_block.hpp"
#include "program/outline.hpp"
#include "program/text/lex.hpp"
#include "program/text/operation.hpp"

namespace counterflex {

struct OpenStructure {
  std::string name;     ///< of O-words: name and keyword; else the keyword
  ModalState before{};  ///< state before it
};

/// What a control has at the begin of a definition that it does not execute, besides its modal state.
struct BeforeDefinition {
  std::size_t begin = 0;                  ///< of its first line in the text
  std::size_t moves = 0, operations = 0;  ///< numbers of them in the program
  std::size_t run_begin = 0;              ///< as in Reading, as the following
  std::array<bool, 3> moved_by_machine{};
  CurrentOperation operation{};
  Variables variables{};
};

/// The conditions, loops and subprograms around a block. Blocks in them may run never or several times.
struct Body {
  std::vector<OpenStructure> open;
  std::optional<ModalState> left{};  ///< state of the paths that leave the outermost structure before its end
  bool subprogram = false;  ///< the outermost structure is a subprogram, which does not run at its place
  BeforeDefinition before_definition{};  ///< of a subprogram of O-words that is the outermost structure
  std::size_t defined_moves = 0;  ///< number of moves in definitions before the first move of the program
  bool jumps = false;             ///< GOTO makes the whole program a body
  /// Bits of Displacement that began behind the last line of flow: another block of the same run may end
  /// them.
  std::uint16_t begun = 0;
};

/// What the program itself sets before its first move. A repetition by M99 begins with it.
struct BeginOfProgram {
  std::uint32_t groups = 0;                    ///< a bit for each CodeGroup
  std::uint16_t ended = 0;                     ///< bits of Displacement
  bool changes_tool = false;                   ///< M6 before the first cut
  bool takes_position = false;                 ///< G92 gives the place at which the operator left the tool
  std::map<std::string, SetOffset> offsets{};  ///< by G10
};

/// State of the reader between blocks. `program` grows. Only moves of an unfinished contour are changed
/// later.
struct Reading {
  const Dialect& dialect;
  const ReadOptions& options;
  std::array<bool, 3> tool_change_axes{};
  Program& program;
  const Outline& outline;
  ModalState state{};
  SortedBlock sorted{};
  double feed_before_mm_min = 0;         ///< that acts before the block; 0: unknown
  std::optional<double> own_feed{};      ///< FB=, of the block alone; 0: unknown
  bool sets_tool_length = false;         ///< the block does
  std::optional<bool> block_relative{};  ///< X=IC(5), X=AC(5): for this block only; overrides the modal state
  /// X=IC(5) beside Y5: a bit for each axis whose word is a difference from the start.
  std::uint8_t relative_axes = 0;
  Body body{};
  CurrentOperation operation{};
  int groups = 0;                              ///< number of contours so far
  std::array<bool, 3> moved_by_machine{};      ///< axes that the machine itself has moved since the last move
  std::size_t run_begin = 0;                   ///< index of the first move after the last machine position
  std::size_t program_numbers = 0;             ///< number of lines so far that begin with an O-number
  std::size_t turns = 0;                       ///< turns of all arcs so far; each arc counts at least one
  double turned_mm = 0;                        ///< length of their full turns
  std::map<std::string, SetOffset> offsets{};  ///< by name
  BeginOfProgram begin{};
  Variables variables{};                     ///< variables with known values, see `evaluate_words`
  CallNames declared{};                      ///< by DEF and PROC of a Sinumerik, in upper case
  std::optional<Word> angle{};               ///< ANG= of the block's line, which gives one of two coordinates
  std::optional<CalledCycle> called{};       ///< by MCALL, at every position
  std::string last_reason{};                 ///< reason of the last uncorrected block
  std::optional<CornerSize> corner{};        ///< corner between the end of the block and the next one
  std::optional<CornerSize> after_corner{};  ///< corner between the last move and the next one
  /// A variable or a computed G10 may have changed tool lengths: those in the options are no longer valid.
  bool lengths_set = false;
  bool uses_tool_length = false;                 ///< G43, G44 or an H of its own was read
  std::map<long, int> cuts_without_tool_length;  ///< by tool, the line of the first one
  bool after_subprogram = false;                 ///< after M99 of a subprogram: another program may follow
  bool ended = false;                            ///< M2 or M30 was read
  int force_line = 0;                            ///< line of the last comment (FORCE ...)

  bool relative() const { return block_relative.value_or(state.relative); }
  bool in_body() const { return body.jumps || !body.open.empty(); }
};

/// Adds `block` to `reading`. Throws `InputError` for invalid or unsupported text.
void interpret(const Block& block, Reading& reading);

}  // namespace counterflex
