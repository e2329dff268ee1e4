#include "report/text/tool_words.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "report/text/text_layout.hpp"

namespace counterflex {
namespace {

constexpr std::size_t shown_tools = 3;

std::string rows_of(const ToolReport& tool) {
  const std::string name = name_of_tool(tool.size);
  const ToolDeviation before = tool.before.value_or(ToolDeviation{});
  const auto& after = tool.after;
  if (!tool.size.diameter)
    return before_after_row(name + ": diameter unknown, tilt deg", mm4(before.tilt_deg),
                            after ? mm4(after->tilt_deg) : "");
  std::string text = before_after_row(name + ": tip", mm4(before.tip_mm), after ? mm4(after->tip_mm) : "") +
                     before_after_row("  rim", mm4(before.rim_mm), after ? mm4(after->rim_mm) : "");
  if (tool.size.flute)
    text += before_after_row(fmt::format("  flank, {:.6g} mm up", *tool.size.flute / mm),
                             mm4(before.flank_mm), after ? mm4(after->flank_mm) : "");
  return text;
}

}  // namespace

std::string name_of_tool(const ToolSize& tool) {
  const std::string name = tool.number == 0 ? "[tool]" : fmt::format("T{}", tool.number);
  return tool.diameter ? fmt::format("{} ({:.6g} mm)", name, *tool.diameter / mm) : name;
}

std::string tilt_in_words(const ToolReport& tool, double tolerance_mm) {
  const ToolDeviation& after = *tool.after;
  std::string parts;
  if (after.rim_mm) parts = fmt::format("its rim is off by up to {} mm", mm4(*after.rim_mm));
  if (after.flank_mm) parts += fmt::format(", its flank by {} mm", mm4(*after.flank_mm));
  return fmt::format(
      "{} stays tilted by up to {} deg: {}, its tip by {} mm; the tolerance of {} mm holds for the tip only",
      name_of_tool(tool.size), mm4(after.tilt_deg), parts, mm4(after.tip_mm), mm4(tolerance_mm));
}

bool may_not_pass(const NarrowedContour& contour, const ToolSize& tool) {
  constexpr double share = 0.8;  // a control's radius is larger where it leaves material for another pass
  return !tool.diameter || *tool.diameter / 2 > share * contour.written_mm * mm;
}

bool passes_only_programmed(const NarrowedContour& contour, const ToolSize& tool) {
  if (!tool.diameter) return false;
  const double radius_mm = *tool.diameter / 2 / mm;
  return radius_mm > contour.written_mm && radius_mm <= contour.programmed_mm;
}

std::string narrowed_in_words(const NarrowedContour& contour, const ToolSize& tool) {
  std::string text = fmt::format(
      "this block of a contour is divided beside an inner corner: the radius of the tool may be at most "
      "{:.2f} "
      "mm in the corrected contour, and at most {:.2f} mm in the programmed one; with a larger one the "
      "control "
      "stops or cuts into the contour; ",
      std::floor(100 * contour.written_mm) / 100, contour.programmed_mm);
  if (tool.diameter && *tool.diameter / 2 > contour.written_mm * mm)
    text += name_of_tool(tool) + " is too large; ";
  else if (tool.diameter)
    text += name_of_tool(tool) + " leaves less than 20 % for a larger radius in the control; ";
  return text + "use a smaller tool or a larger --tolerance-mm";
}

std::string tool_rows(const RunReport& report) {
  std::string text;
  const std::size_t shown = std::min(shown_tools, report.tools_off.size());
  for (std::size_t i = 0; i < shown; ++i) text += rows_of(report.tools_off[i]);
  if (report.tools_off.size() > shown)
    text += fmt::format("  and {} more tools: --report shows them\n", report.tools_off.size() - shown);
  return text;
}

}  // namespace counterflex
