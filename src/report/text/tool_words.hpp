#pragma once
/// Tilted tools in words.
#include "counterflex/report/report.hpp"

namespace counterflex {

/// "T1 (20 mm)"; "T1"; "[tool]" if the program selects no tool.
std::string name_of_tool(const ToolSize& tool);

/// A warning that the rim or the flank of a tool is off by more than the tolerance, though its tip is within
/// it.
std::string tilt_in_words(const ToolReport& tool, double tolerance_mm);

/// Rows of the deviation table: tip, rim and flank of each tool, in µm; or the tilt, if the diameter is
/// unknown.
std::string tool_rows(const RunReport& report);

}  // namespace counterflex
