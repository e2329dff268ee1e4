#pragma once
/// The operation of a move: the last comment that is alone in its line.
#include <cstdint>
#include <string>
#include <string_view>

#include "program/text/lex.hpp"

namespace counterflex {

/// A tool number as in Move::tool; 0 (unknown) if it is out of range.
inline std::int32_t as_tool(long number) {
  return number > 0 && number <= INT32_MAX ? static_cast<std::int32_t>(number) : 0;
}

/// Whether a comment is a line of the header of a corrected program: "COUNTERFLEX 1", alone or followed by
/// other words.
bool is_header_comment(std::string_view comment);

/// Whether comments are alone in the line of `block`. Only a block number and '/', which does not skip
/// comments, may be beside them.
bool has_comments_alone(std::string_view text, const Block& block);

/// The name in a comment: without the blanks, dashes, asterisks and other marks around it. Empty for marks
/// only and for lines of a header.
std::string_view operation_name(std::string_view comment);

/// The active operation. It is added to `Program::operations` with its first move.
class CurrentOperation {
 public:
  /// Sets the operation to `comment`, which is alone in its line and not a FORCE comment. False if it has no
  /// name.
  bool name(std::string_view comment);

  /// Index into `Program::operations`. Once a move has the active operation, it is the last entry.
  std::uint32_t index_in(Program& program) {
    if (is_new_) add_to(program);
    return index_;
  }

  /// Begins a window: its first operation is the active one, or that of the move before the window.
  void begin_window(Program& program);

 private:
  void add_to(Program& program);

  std::string text_;
  std::uint32_t index_ = 0;
  bool is_new_ = false;
};

}  // namespace counterflex
