#pragma once
/// Replaces calls of subprograms by their bodies, before a program is read.
#include <string>

#include "counterflex/program/program.hpp"
#include "program/dialect.hpp"
#include "program/text/lex.hpp"

namespace counterflex {

/// Replaces calls in `text` whose words are plain numbers (M98, M97 of a Haas, LinuxCNC's O-words) by copies
/// of the bodies in the same text, L of M98 times. Calls in the copies are replaced, too. A copy has every
/// byte of a body except its O, M99, sub and endsub lines. In the body of an O-word the arguments replace #1
/// to #30, and values replace local variables. The block of a call keeps its other words, its N and its
/// comments. Definitions stay. Calls that cannot be replaced stay, too, with the reason.
/// Loops, conditions and jumps of the program and of these bodies are replaced by the lines that they
/// execute: FOR, WHILE, LOOP, REPEAT, IF and GOTO of a Sinumerik, the O-words of LinuxCNC, WHILE, DO, IF and
/// GOTO of shop controls. If a condition of the program is not known from the text, or if the lines exceed
/// the limits below, all of them stay, with the reason. Calls of a Sinumerik are not replaced.
/// Throws `InputError` (ErrorKind::program_text) for text that is not G-code, for a subprogram that always
/// calls itself, and if calls exceed the limits.
Expansion expand_subprograms(std::string& text, const std::string& file, const Dialect& dialect);

/// Whether calls of the dialect can be replaced.
bool may_expand(const Dialect& dialect);

/// Whether loops, conditions and jumps of the dialect can be executed.
bool may_execute(const Dialect& dialect);

/// Limits of what an expansion adds to a program. The result is one window, whose moves need 1 to 8 kB each.
constexpr std::size_t most_added_lines = 500'000, most_added_bytes = 64'000'000;
constexpr std::size_t most_expanded_calls = 1'000'000;

/// An expansion so far: its lines with those that have run, its text and its calls.
struct ExpandedSize {
  std::size_t lines, bytes, calls;
};

/// Which limit an expansion of `original` exceeds: "the expansion adds more than 500000 lines"; empty if it
/// exceeds none.
std::string limit_exceeded(const ExpandedSize& expanded, const ExpandedSize& original);

/// Sets the line of `block` to the line of the file from which the line of the text comes.
void place_in_file(const Expansion& expansion, Block& block);

/// Whether the line at byte `at` of the text belongs to a definition whose blocks do not run at their place.
bool is_unused(const Expansion& expansion, std::size_t at);

/// Adds a definition whose blocks do not run at their place.
void add_unused(Span definition, Expansion& expansion);

/// Why the call in line `text_line` of the text was not replaced; empty if expansion was off.
std::string_view why_not_expanded(const Expansion& expansion, int text_line);

/// Adds remarks on the expansion.
void remark_expansion(Program& program);

}  // namespace counterflex
