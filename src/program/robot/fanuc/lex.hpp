#pragma once
/// Lines, statements and words of FANUC TP programs (.ls), as spans of the text.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "program/robot/line.hpp"

namespace counterflex {

inline constexpr std::string_view tp_comment = "!";

/// The sections of a program. Other sections (/ATTR, /APPL) count as `attributes`.
enum class TpSection { attributes, statements, positions, end };

/// The section that begins in `line`: "/MN", "/POS", "/END". Empty for other lines.
std::optional<TpSection> tp_section(std::string_view line);

/// "  12:" at the begin of a line of /MN.
struct TpLineNumber {
  Span field;   ///< from the begin of the line to the statement, with the blanks around the colon
  Span digits;  ///< empty for a line without a number, which often continues the line before
};
std::optional<TpLineNumber> tp_line_number(std::string_view text, Span line);

/// The physical line after `line.line_end`, without a comment; false at the end of `text`.
bool next_physical_line(std::string_view text, RobotLine& line);

/// The next line, in /MN the next statement with the lines that continue it: up to a ';' at the end of a
/// line, or to a line with a number. Its code is without the number and the ';'. A remark has no code.
bool next_tp_line(std::string_view text, TpSection section, RobotLine& line);

/// Whether `c` is a blank, a line end or a control character of transmission.
bool is_tp_space(char c);

/// Whether `span` ends with ';'.
bool ends_with_semicolon(std::string_view text, Span span);

/// The words of a statement, separated by blanks, line ends and the colons of continuation lines. Brackets
/// keep their text together.
std::vector<Span> tp_words(std::string_view text, Span code);

/// Text in upper case without blanks and line ends.
std::string tp_word(std::string_view text);

/// "P[3]", "P[3:name]", "PR[2]", "P[R[1]]".
struct TpOperand {
  std::string array;             ///< "P", "PR", ...
  std::optional<long> number{};  ///< empty: it is computed
  Span span;                     ///< of the whole operand
};
std::optional<TpOperand> tp_operand(std::string_view text, Span word);

/// The whole number at byte `at`, with blanks before it and `end` behind its digits. Empty without one.
struct TpInteger {
  long value = 0;
  std::size_t end = 0;
};
std::optional<TpInteger> tp_integer(std::string_view text, std::size_t at);

/// The operands "P[...]" of a statement, in order.
std::vector<TpOperand> tp_positions_in(std::string_view text, Span code);

}  // namespace counterflex
