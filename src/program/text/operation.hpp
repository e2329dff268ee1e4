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

/// The active operation. It is added to `Program::operations` with its first move. Its title is the first
/// comment after a tool change, a blank line or a rapid move, before the next feed move. Other comments are
/// remarks: the title stays.
class CurrentOperation {
 public:
  /// Sets the operation to `comment`, which is alone in its line and not a FORCE comment. False if it has no
  /// name. `tool`: the tool in the spindle.
  bool name(std::string_view comment, std::int32_t tool);

  /// The next comment may be a title: after a blank line, and for a structure line.
  void expect_title() { expects_title_ = true; }

  /// Index into `Program::operations` for a move. Once a move has the active operation, it is the last entry.
  std::uint32_t index_in(Program& program, Motion motion, std::int32_t tool) {
    if (is_new_) add_to(program);
    expects_title_ = motion == Motion::rapid;
    has_title_ = false;
    tool_ = tool;
    return index_;
  }

  /// Begins a window: its first operation is the active one, or that of the move before the window.
  void begin_window(Program& program);

 private:
  void add_to(Program& program);

  std::string text_, title_;
  std::uint32_t index_ = 0;
  std::int32_t tool_ = 0;  ///< at the last comment or move
  bool is_new_ = false, expects_title_ = false;
  bool has_title_ = false;  ///< since the last move
};

}  // namespace counterflex
