#pragma once
/// Tilted tools in words.
#include "counterflex/report/report.hpp"

namespace counterflex {

/// "T1 (20 mm)"; "T1"; "[tool]" where the program calls none.
std::string name_of_tool(const ToolSize& tool);

/// That the rim or the flank of a tool is off by more than the tolerance, though its tip is within it.
std::string tilt_in_words(const ToolReport& tool, double tolerance_mm);

/// Rows of the deviation table: tip, rim and flank of each tool, in um; where a diameter is not known, the tilt
/// instead.
std::string tool_rows(const RunReport& report);

}  // namespace counterflex
