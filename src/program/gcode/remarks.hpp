#pragma once
/// Remarks for the report: words of a program that may cancel small corrections, and assumptions.
#include <string>
#include <string_view>

#include "program/gcode/interpret.hpp"

namespace counterflex {

/// For holes of Klartext and Sinumerik to which a feed move leads.
constexpr std::string_view feed_to_hole =
    "a feed move to a hole is corrected at its end in X and Y alone: call the cycle in a block of its own";

/// For pockets and slots about one point (Move::mills_at_end): why they are not fully corrected.
constexpr std::string_view milled_as_a_whole =
    "the cycle is shifted as a whole with its centre; rotation and tilt across it are not corrected";

/// For tools that are called by a name or by an expression.
constexpr std::string_view tool_without_number =
    "the tool is called without a number: the tip and the stiffness of [tool] are used for it, and --guard "
    "does "
    "not check it";

/// Begin of the remark of `assume_of_calls`.
constexpr std::string_view assumption_of_calls = "assumed from here on: called programs do not change ";

/// Adds a remark, once for each text.
void add_remark(Program& program, int line, std::string what);

/// A program or routine is called that is not read. Adds the remark that states what counts as unchanged
/// behind such calls.
void assume_of_calls(Program& program, int line);

/// Whether the machine file states that the called program leaves the machine and its state as they are. Adds
/// a remark with its name.
bool is_stated_harmless(Program& program, const ReadOptions& options, int line, std::string_view name);

/// Deviation from the path that G64, G5.1 and G187 allow the control.
void remark_path_mode(const Block& block, Reading& reading);

/// The tool length of a G43 or G44 is unknown.
void remark_tool_length(const Block& block, Reading& reading);

/// Whether the active H is another number than the tool in the spindle, and its length is not known to be the
/// same.
bool is_other_length(const Reading& reading);

/// A warning in `line` if that is so.
void remark_other_length(int line, Reading& reading);

/// The tool cuts in `line`: a warning if no tool length acts there and another one acts elsewhere in the
/// program, before or behind it. Once for each tool.
void remark_cut_without_length(int line, Reading& reading);

/// The first block with a tool length: the warnings about the cuts before it.
void remark_cuts_before_length(Reading& reading);

/// The tool of T has no number.
void remark_named_tool(const Block& block, Reading& reading);

/// Codes that the machine builder defines.
void remark_machine_codes(const Block& block, Reading& reading);

/// A line is longer than the control reads.
void remark_length(const Block& block, Reading& reading);

}  // namespace counterflex
