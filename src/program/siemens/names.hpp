#pragma once
/// Names of a Sinumerik, as data. Upper and lower case are the same.
#include <optional>
#include <string_view>

#include "program/text/lex.hpp"

namespace counterflex {

/// Effect of a name at the beginning of a statement on later moves. Names without one are subprograms,
/// cycles, or in one of the lists below.
std::optional<Statement> statement_of_name(std::string_view name);

/// Whether the name neither moves an axis nor affects moves: MSG, SPOS, DYNNORM.
bool is_harmless_name(std::string_view name);

/// Whether a harmless name sets a feed or a speed, or stops a spindle.
bool is_speed_name(std::string_view name);

/// $AC_TIMER, $A_OUT: a variable of the control without an effect on coordinates.
bool is_harmless_variable(std::string_view name);

/// IF, WHILE, REPEAT and the other words of conditions and loops.
bool is_siemens_structure(std::string_view name);

/// Whether an assignment to the name affects moves: AP, POS.
bool is_position_name(std::string_view name);

/// Whether an assignment to the name changes the offset of the tool: TOFFL, DL, TCARR.
bool is_tool_offset_name(std::string_view name);

/// DIV, AND and the other operators that are words.
bool is_siemens_operator(std::string_view name);

/// CYCLE81, POCKET3, HOLES1.
bool is_cycle_name(std::string_view name);

}  // namespace counterflex
