#pragma once
/// Lines and plain numbers of robot programs, as spans of the text.
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "counterflex/program/program.hpp"

namespace counterflex {

/// A line of a robot program.
struct RobotLine {
  int line = 0;        ///< from 1: the first, if the statement continues in more lines
  int more_lines = 0;  ///< number of lines after the first
  Span span;           ///< without the line end
  Span line_end;       ///< empty for a last line without line end
  Span code;           ///< the statement, without comment and without blanks around it
  Span comment;        ///< text behind the comment mark; empty without one
};

/// Moves `line` to the line after `line.line_end`; false at the end of `text`. A default line is before the
/// first line. `comment_mark` begins a comment, but not inside of a string in double quotes.
bool next_robot_line(std::string_view text, std::string_view comment_mark, RobotLine& line);

/// A number: sign, digits, decimal point, exponent.
struct RobotNumber {
  Span span;
  double value = 0;
  int decimals = 0;  ///< digits between the decimal point and the exponent

  AxisWord word() const { return {span, decimals}; }
};

/// The number at byte `at` of `text`. Empty for other text, and if a letter, digit or point follows it.
std::optional<RobotNumber> number_at(std::string_view text, std::size_t at);

/// The first byte from `at` on that is not a blank or a tab, at most `end`.
std::size_t behind_blanks(std::string_view text, std::size_t at, std::size_t end);

/// Whether `word` is one of `words`.
bool is_among(std::string_view word, std::span<const std::string_view> words);

/// Throws an `InputError` (ErrorKind::program_text) at byte `at` of `line`.
[[noreturn]] void refuse(const std::string& file, const RobotLine& line, std::size_t at,
                         const std::string& message);

}  // namespace counterflex
