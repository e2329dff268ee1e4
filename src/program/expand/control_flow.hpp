#pragma once
/// The lines of a program, or of a body, that say which line follows them: loops, conditions and jumps.
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "program/text/lex.hpp"

namespace counterflex {

/// The beginning of a line.
struct LinePlace {
  std::size_t at = 0;
  int line = 1;
};

enum class FlowKind : std::uint8_t {
  label,  ///< nothing but the target of jumps
  jump,
  begin_if,
  else_if,
  otherwise,
  end_if,
  begin_while,
  either_while,  ///< of LinuxCNC: begins a loop, or ends one that DO began; `join_structures` decides it
  begin_loop,    ///< without a condition
  end_loop,      ///< back to the beginning
  loop_while,    ///< ends a loop without a condition, or runs it once more
  loop_until,
  begin_repeat,
  end_repeat,
  begin_for,
  end_for,
  leave_loop,
  next_pass,
  leave_body,
  assign_if,    ///< IF [...] THEN #1=5
  not_followed  ///< a keyword that is not executed
};

struct ControlLine {
  FlowKind kind = FlowKind::label;
  LinePlace begin, behind;      ///< this line and the next
  Span label{};                 ///< of a Sinumerik, with ':'
  std::string keyword{};        ///< as it is written, for messages
  std::string name{};           ///< the same of the lines of one structure: "100" of O100, "1" of DO1, "IF"
  std::string condition{};      ///< or the count of a repetition, or "R1=1 TO 5" of FOR
  std::string target{};         ///< of a jump: "GOTOB LABEL", "10", "[#1+1]"
  Span rest{};                  ///< of `assign_if`: the assignment
  std::size_t partner = 0;      ///< the line that ends or begins the structure; of a branch its end
  std::size_t next_branch = 0;  ///< of IF and ELSEIF
};

struct ControlFlow {
  std::vector<ControlLine> lines{};                           ///< in order
  std::map<std::string, std::vector<LinePlace>> labels{};  ///< targets of jumps, by name or block number
};

/// What an execution cannot continue behind. Thrown by what follows.
struct UnknownFlow {
  int line;
  std::string why;
};

/// Adds `block` if it is a line of flow, or a target of jumps. Of a dialect with block numbers, these are targets only
/// with `jumps`.
void add_flow(std::string_view text, const Dialect& dialect, const Block& block, bool jumps, ControlFlow& flow);

/// Finds the partners of all lines.
void join_structures(ControlFlow& flow);

/// The line of flow that begins where `block` does, or nullptr.
const ControlLine* flow_line_at(const ControlFlow& flow, const Block& block);

/// Whether anything but labels stands in it.
bool has_flow(const ControlFlow& flow);
bool has_jumps(const ControlFlow& flow);

/// The readers of `add_flow`.
void add_siemens_flow(std::string_view text, const Block& block, ControlFlow& flow);
void add_o_word(std::string_view text, const Block& block, ControlFlow& flow);
void add_macro_word(std::string_view text, const Block& block, bool jumps, ControlFlow& flow);

/// The counter, the begin and the end of "R1=1 TO 5". Throws `UnknownFlow` for other texts.
struct CountedLoop {
  std::string_view counter, first, last;
};
CountedLoop read_counted_loop(const ControlLine& line);

/// A flow line that begins where `block` does.
ControlLine flow_line_of(const Block& block);

std::string upper_case(std::string_view text);
/// Without blanks at its edges.
std::string_view trimmed_text(std::string_view text);

}  // namespace counterflex
