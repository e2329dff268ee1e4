#pragma once
/// Statements of ABB RAPID. A line may have several, and a statement may continue in further lines.
#include <string>
#include <string_view>

#include "program/robot/rapid/lex.hpp"

namespace counterflex {

enum class RapidKind {
  none,  ///< the end of the text
  module_begin,
  module_end,
  routine_begin,  ///< PROC, FUNC, TRAP with its parameters
  routine_end,
  handler,     ///< ERROR, UNDO, BACKWARD: what follows runs after an error
  body_begin,  ///< IF ... THEN, FOR, WHILE, TEST
  body_end,
  branch,    ///< ELSEIF, ELSE, CASE, DEFAULT
  short_if,  ///< "IF condition statement;"
  label,
  declaration,  ///< VAR, PERS, CONST, and definitions of types
  assignment,
  call  ///< a motion or another instruction, or a routine
};

struct RapidStatement {
  RapidKind kind = RapidKind::none;
  std::string head;      ///< first name in upper case, behind LOCAL and TASK
  Span span;             ///< without the semicolon
  std::size_t rest = 0;  ///< behind `head`
  std::size_t behind = 0;
  bool ended = true;  ///< it ends before the end of the text
};

/// The first statement from byte `at` on.
RapidStatement rapid_statement_at(std::string_view text, std::size_t at, std::size_t end);

/// Whether a statement of that kind has expressions.
bool has_expressions(RapidKind kind);

/// Position of the statement in "IF condition statement;": of the first name behind a complete operand.
std::size_t statement_of_short_if(std::string_view text, const RapidStatement& statement);

/// "VAR robtarget p1 := [...]": empty name if the statement does not declare data.
struct RapidDeclaration {
  std::string type;  ///< in upper case
  Span name;
  Span value;             ///< behind ":="; empty without one
  bool constant = false;  ///< CONST
  bool array = false;
};
RapidDeclaration rapid_declaration(std::string_view text, const RapidStatement& statement);

}  // namespace counterflex
