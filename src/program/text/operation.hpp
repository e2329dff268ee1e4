#pragma once
/// The operation of a move: what the comment says that stood last alone in its line.
#include <cstdint>
#include <string>
#include <string_view>

#include "program/text/lex.hpp"

namespace counterflex {

/// A tool's number as moves have it: 0, none known, where it has no place there.
inline std::int32_t as_tool(long number) {
  return number > 0 && number <= INT32_MAX ? static_cast<std::int32_t>(number) : 0;
}

/// Whether a comment is a line of the header of a corrected program: "COUNTERFLEX 1", alone or followed by
/// more words.
bool is_header_comment(std::string_view comment);

/// Whether comments stand alone in the line of `block`: beside a block number and '/' at most, which skips
/// no comment.
bool has_comments_alone(std::string_view text, const Block& block);

/// The name that a comment gives: without the blanks, dashes, asterisks and other marks around it; empty for
/// marks alone and for lines of a header.
std::string_view operation_name(std::string_view comment);

/// The operation that acts, which goes into `Program::operations` with the first move that it has.
class CurrentOperation {
 public:
  /// What `comment`, alone in its line and no FORCE comment, says; false where it names nothing.
  bool name(std::string_view comment);

  /// Index into `Program::operations`, whose last one is ours once a move has it.
  std::uint32_t index_in(Program& program) {
    if (is_new_) add_to(program);
    return index_;
  }

  /// A window begins: the operation that acts is its first, that of the move before it another one at most.
  void begin_window(Program& program);

 private:
  void add_to(Program& program);

  std::string text_;
  std::uint32_t index_ = 0;
  bool is_new_ = false;
};

}  // namespace counterflex
