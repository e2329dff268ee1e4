#include "program/robot/kuka/guard.hpp"

#include <fmt/format.h>

#include "counterflex/geometry/pose.hpp"
#include "counterflex/geometry/types.hpp"
#include "program/guard/guard_mark.hpp"
#include "program/guard/guard_text.hpp"

namespace counterflex {
namespace {

class KukaLines {
 public:
  explicit KukaLines(const Guard& guard) { lines_.push_back("; " + guard_title(guard)); }

  void refuse_if(const std::string& condition, const std::string& message) {
    lines_.push_back(marked_line(fmt::format("IF {} THEN ; ", condition), ""));
    lines_.push_back("; COUNTERFLEX 1 GUARD: " + message);
    for (const char* statement : {"LOOP", "HALT", "ENDLOOP", "ENDIF"})
      lines_.push_back(marked_line(std::string(statement) + " ; ", ""));
  }

  std::vector<std::string> take() { return std::move(lines_); }

 private:
  std::vector<std::string> lines_;
};

}  // namespace

// KUKA System Software 8.x, "Operating and Programming Instructions for System Integrators", chapter "KRL
// syntax": IF THEN ENDIF; LOOP ENDLOOP repeats for ever; HALT stops the program, and the start key continues
// it behind the HALT, here with the next one. Section "System variables": $BASE and $TOOL are the base and
// the tool that act, mm and degrees (A about Z, B about Y, C about X); TOOL_DATA[n] are the tools by number.
std::vector<std::string> kuka_guard(const Guard& guard) {
  KukaLines lines(guard);
  for (int axis = 0; axis < 3; ++axis) {
    const GuardedValue v =
        guarded_value(guard.active.shown_mm[axis], guard.window_mm, LengthUnit::millimetres);
    const char name = "XYZ"[axis];
    lines.refuse_if(fmt::format("ABS($BASE.{}-({}))>{}", name, v.value, v.window),
                    fmt::format("$BASE.{} MUST BE {}", name, v.range));
  }
  const Vector3 rpy_deg = to_rpy(*guard.active.R) / deg;
  for (int i = 0; i < 3; ++i) {
    const char name = "ABC"[i];
    const std::string off = fmt::format("ABS($BASE.{}-({}))", name, guard_number(rpy_deg[2 - i]));
    lines.refuse_if(fmt::format("({0}>{1}) AND (ABS({0}-360)>{1})", off, guarded_angle_deg),
                    fmt::format("$BASE.{} MUST BE {} DEG", name, guard_number(rpy_deg[2 - i])));
  }
  if (guard.tool > 0)
    lines.refuse_if(fmt::format("ABS($TOOL.X-TOOL_DATA[{0}].X)+ABS($TOOL.Y-TOOL_DATA[{0}].Y)+"
                                "ABS($TOOL.Z-TOOL_DATA[{0}].Z)>0.01",
                                guard.tool),
                    fmt::format("$TOOL MUST BE TOOL_DATA[{}]", guard.tool));
  return lines.take();
}

std::string why_no_kuka_guard(const Guard&) {
  return "";
}

}  // namespace counterflex
