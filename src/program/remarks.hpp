#pragma once
/// Remarks for the report: what in a program may undo small corrections or needs an assumption.
#include <string>

#include "program/interpret.hpp"

namespace counterflex {

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
