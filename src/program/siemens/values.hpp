#pragma once
/// Names and values of a Sinumerik at the place of a scanner, which then moves behind them.
#include <string_view>

#include "program/text/scanner.hpp"

namespace counterflex {

/// The name at the scanner, which does not move. Empty without a name.
std::string_view siemens_name_at(const Scanner& scanner);

/// Skips to the comment.
void skip_siemens_rest(Scanner& scanner);

/// A value, up to a blank outside of brackets and quotes, or the word directly behind a number or a bracket:
/// "10F600", "AC(5)Y2". Throws `InputError` if the end of the value is not certain: "R1F600".
void skip_siemens_value(Scanner& scanner);

/// "[X]", "[R1, 2]".
void skip_siemens_index(Scanner& scanner);

/// Assigns the expression behind the '=' at the scanner to `variable`.
void take_assigned(Scanner& scanner, Span variable);

/// "S1=4000", "FB=R1", "SETMS(2)", "SETMS": a SpeedWord whose name has `name_length` characters.
void take_speed_word(Scanner& scanner, std::size_t name_length);

/// A word whose name has `name_length` characters, with '=' and its value: a number, AC(number), IC(number)
/// or an expression. "CR=4." is the radius of an arc (`letter` R), "TURN=2" its additional full turns (P).
/// Throws `InputError` (ErrorKind::program_text) if there is no value.
void read_named_word(Scanner& scanner, char letter, std::size_t name_length);

}  // namespace counterflex
