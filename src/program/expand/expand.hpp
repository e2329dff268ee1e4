#pragma once
/// Puts the bodies of subprograms in the place of their calls, before a program is read.
#include <algorithm>
#include <string>

#include "counterflex/program/program.hpp"
#include "program/dialect.hpp"
#include "program/text/lex.hpp"

namespace counterflex {

/// Replaces calls in `text` that say all in plain numbers (M98, M97 of a Haas, LinuxCNC's O-words) by copies
/// of the bodies that stand in the same text, L of M98 times, and calls in these copies likewise. Copies hold
/// every byte of a body but its O, M99, sub and endsub lines; in those of an O-word the arguments stand for
/// #1 to #30, and local variables are replaced by their values. A call block keeps its other words, its N and its
/// comments. Definitions stay where they are; calls that cannot be replaced stay too, with the reason.
/// Loops, conditions and jumps of the program and of these bodies are replaced by the lines that they execute:
/// FOR, WHILE, LOOP, REPEAT, IF and GOTO of a Sinumerik, the O-words of LinuxCNC, WHILE, DO, IF and GOTO of shop
/// controls. Those of the program all stay, with the reason, where a condition is not known from the text, or where
/// more than 150 000 lines would run again. The calls of a Sinumerik are not replaced.
/// Throws `InputError` (Exit::program_text) for what is no G-code, for a subprogram that always calls itself, and where
/// calls make more than `largest_expansion` bytes.
Expansion expand_subprograms(std::string& text, const std::string& file, const Dialect& dialect);

/// Whether calls of the dialect can be replaced.
bool may_expand(const Dialect& dialect);

/// Whether loops, conditions and jumps of the dialect can be executed.
bool may_execute(const Dialect& dialect);

/// Bytes that a program of `bytes` may become: it is one window, whose moves need a thousand times as much memory.
constexpr std::size_t largest_expansion(std::size_t bytes) {
  return std::max(std::size_t{250'000}, 4 * bytes);
}
constexpr std::size_t most_expanded_calls = 1'000'000;

/// Sets `block`'s line to the one of the file that the line of the text comes from.
void place_in_file(const Expansion& expansion, Block& block);

/// Whether the line that begins at byte `at` of the text belongs to a definition that nothing calls any more.
bool stands_unused(const Expansion& expansion, std::size_t at);

/// Why the call in line `text_line` of the text was not replaced; empty where nothing was asked.
std::string_view why_not_expanded(const Expansion& expansion, int text_line);

/// Remarks on what was done.
void remark_expansion(Program& program);

}  // namespace counterflex
