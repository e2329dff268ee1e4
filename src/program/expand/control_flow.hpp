#pragma once
/// Lines of a program or of a body that control the flow: loops, conditions and jumps.
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "program/text/lex.hpp"

namespace counterflex {

/// The position of the beginning of a line.
struct LinePlace {
  std::size_t at = 0;
  int line = 1;
};

enum class FlowKind : std::uint8_t {
  label,  ///< only a target of jumps
  jump,
  begin_if,
  else_if,
  otherwise,
  end_if,
  begin_while,
  either_while,  ///< of LinuxCNC: begins a loop, or ends a DO loop; `join_structures` decides
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
  not_followed  ///< a keyword that is not supported
};

struct ControlLine {
  FlowKind kind = FlowKind::label;
  LinePlace begin, behind;  ///< this line and the next
  Span label{};             ///< of a Sinumerik, with ':'
  std::string keyword{};    ///< as it is written, for messages
  std::string name{};       ///< identifies the lines of one structure: "100" of O100, "1" of DO1, "IF"
  std::string condition{};  ///< or the count of a repetition, or "R1=1 TO 5" of FOR
  std::string target{};     ///< of a jump: "GOTOB LABEL", "10", "[#1+1]"
  Span rest{};              ///< of `assign_if`: the assignment
  std::size_t partner = 0;  ///< index of the line that ends or begins the structure; of a branch, of its end
  std::size_t next_branch = 0;  ///< of IF and ELSEIF
};

struct ControlFlow {
  std::vector<ControlLine> lines{};                        ///< in order of the text
  std::map<std::string, std::vector<LinePlace>> labels{};  ///< targets of jumps, by name or block number
};

/// The execution cannot continue, because the text does not determine the next line. Thrown by the functions
/// below.
struct UnknownFlow {
  int line;
  std::string why;
};

/// Adds `block` if it controls the flow or is a target of jumps. In a dialect with block numbers, numbers are
/// targets only if `jumps`.
void add_flow(std::string_view text, const Dialect& dialect, const Block& block, bool jumps,
              ControlFlow& flow);

/// Finds the partners of all lines.
void join_structures(ControlFlow& flow);

/// The line of `flow` at the begin of `block`, or nullptr.
const ControlLine* flow_line_at(const ControlFlow& flow, const Block& block);

/// Whether it has lines other than labels.
bool has_flow(const ControlFlow& flow);
bool has_jumps(const ControlFlow& flow);

/// Readers of the languages, used by `add_flow`.
void add_siemens_flow(std::string_view text, const Block& block, bool jumps, ControlFlow& flow);
void add_o_word(std::string_view text, const Block& block, ControlFlow& flow);
void add_macro_word(std::string_view text, const Block& block, bool jumps, ControlFlow& flow);

/// The counter, the begin and the end of "R1=1 TO 5". Throws `UnknownFlow` for other text.
struct CountedLoop {
  std::string_view counter, first, last;
};
CountedLoop read_counted_loop(const ControlLine& line);

/// A line of flow at the begin of `block`.
ControlLine flow_line_of(const Block& block);

/// Without blanks at its ends.
std::string_view trimmed_text(std::string_view text);

}  // namespace counterflex
