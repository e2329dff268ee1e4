#pragma once
/// Remarks for the report: what in a program may undo small corrections or needs an assumption.
#include <string>
#include <string_view>

#include "program/gcode/interpret.hpp"

namespace counterflex {

/// Of pockets and slots about one point (Move::mills_at_end): why they are not wholly corrected.
constexpr std::string_view milled_as_a_whole =
    "what the cycle mills goes along with its centre as a whole; turn and tilt across it are not corrected";

/// Adds a remark, once for each text.
void add_remark(Program& program, int line, std::string what);

/// What G64, G5.1 and G187 let the control do with the path.
void remark_path_mode(const Block& block, Reading& reading);

/// That the tool length of a G43 or G44 is not known here.
void remark_tool_length(const Block& block, Reading& reading);

/// Codes of which only the machine's builder knows what they do.
void remark_machine_codes(const Block& block, Reading& reading);

/// That a line is longer than the control reads.
void remark_length(const Block& block, Reading& reading);

}  // namespace counterflex
