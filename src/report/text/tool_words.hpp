#pragma once
/// Tools in words: tilted ones, and those that may not pass a contour.
#include "counterflex/compensation/windows.hpp"
#include "counterflex/report/report.hpp"

namespace counterflex {

/// "T1 (20 mm)"; "T1"; "[tool]" if the program selects no tool.
std::string name_of_tool(const ToolSize& tool);

/// A warning that the rim or the flank of a tool is off by more than the tolerance, though its tip is within
/// it.
std::string tilt_in_words(const ToolReport& tool, double tolerance_mm);

/// Whether a control may refuse the tool in a narrowed contour: it does not fit with room to spare, or its
/// diameter is unknown.
bool may_not_pass(const NarrowedContour& contour, const ToolSize& tool);

/// Whether the tool passes the programmed contour, but not the corrected one. Where it passes neither, the
/// control may have another radius: that of a path of the centre is 0.
bool passes_only_programmed(const NarrowedContour& contour, const ToolSize& tool);

/// A warning that a contour is narrowed.
std::string narrowed_in_words(const NarrowedContour& contour, const ToolSize& tool);

/// Rows of the deviation table: tip, rim and flank of each tool, in µm; or the tilt, if the diameter is
/// unknown.
std::string tool_rows(const RunReport& report);

}  // namespace counterflex
