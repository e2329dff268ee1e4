#pragma once
/// Statements of APT and of cutter location files (CLS): "GOTO/1,2,3,0,0,1 $$ comment". ISO 4342 and ISO
/// 3592.
#include <string>
#include <string_view>
#include <vector>

#include "program/robot/line.hpp"

namespace counterflex {

inline constexpr std::string_view apt_comment = "$$";

/// A statement: the text before '/', and the parameters behind it.
struct AptStatement {
  std::string head;              ///< in upper case without blanks: "GOTO"
  std::vector<Span> parameters;  ///< between commas, without blanks and continuation signs around them
};

/// As `next_robot_line`: the next statement with all lines over which '$' continues it. Its code then has
/// line ends. A remark of Creo, "$$-> CSYS/1,0,0,0,$", takes the lines of numbers that continue it.
bool next_apt_line(std::string_view text, RobotLine& line);

/// Whether the statement or the remark of the line that ends at `newline` continues in the next one.
bool apt_continues_behind(std::string_view text, std::size_t newline);

/// The statement `code`.
AptStatement apt_statement(std::string_view text, Span code);

/// `parameter` in upper case without blanks.
std::string apt_word(std::string_view parameter);

/// Whether a GOTO/ of `lines` gives a tool axis.
bool gives_tool_axes(std::string_view lines);

}  // namespace counterflex
