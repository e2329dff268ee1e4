#include "program/gcode/guard.hpp"

#include <fmt/format.h>

#include "program/guard/guard_mark.hpp"
#include "program/guard/guard_text.hpp"

namespace counterflex {
namespace {

/// The lines of a LinuxCNC guard. The names of its O-words must not be those of the program.
class LinuxcncLines {
 public:
  explicit LinuxcncLines(const Guard& guard) { add(fmt::format("({})", guard_title(guard))); }

  void refuse_if(const std::string& condition, const std::string& message) {
    const std::string name = fmt::format("o<counterflex_guard_{}>", ++count_);
    add(marked_line(fmt::format("{} if [{}] (", name, condition), ")"));
    add(marked_line("(", fmt::format(") (abort, COUNTERFLEX GUARD: {})", message)));  // the last comment acts
    add(marked_line(name + " endif (", ")"));
  }

  std::vector<std::string> take() { return std::move(lines_); }

 private:
  void add(std::string line) { lines_.push_back(std::move(line)); }

  std::vector<std::string> lines_;
  int count_ = 0;
};

/// The lines of a guard of custom macros. Alarms have numbers from 101 on, and at most 26 characters.
class MacroLines {
 public:
  explicit MacroLines(const Guard& guard) { lines_.push_back(fmt::format("({})", guard_title(guard))); }

  void refuse_if(const std::string& condition, const std::string& message) {
    constexpr int first_alarm = 101;
    const std::string before = fmt::format("IF [{}] THEN #3000={}(", condition, first_alarm + count_++);
    lines_.push_back(marked_line(before, fmt::format(" {})", message)));
  }

  std::vector<std::string> take() { return std::move(lines_); }

 private:
  std::vector<std::string> lines_;
  int count_ = 0;
};

/// Where the numbers of a work offset are: "#5221" for X of G54. The first is X, the next Y and Z.
int first_offset_variable(OffsetNumber offset) {
  constexpr int basic = 5201, few = 6981, many = 13981, most_few = 48;
  if (offset.basic > 0) return basic + 20 * offset.basic;
  return (offset.additional <= most_few ? few : many) + 20 * offset.additional;
}

void check_unit_and_offset(const Guard& guard, MacroLines& lines) {
  const bool metric = guard.unit == LengthUnit::millimetres;
  lines.refuse_if(fmt::format("#4006 NE {}", metric ? 21 : 20), metric ? "G21" : "G20");
  const OffsetNumber offset = number_of_offset(guard.active.name);
  if (offset.basic > 0)
    lines.refuse_if(fmt::format("#4014 NE {}", 53 + offset.basic), guard.active.name);
  else
    lines.refuse_if(fmt::format("#4130 NE {}", offset.additional), guard.active.name);
  for (int axis = 0; axis < 3; ++axis) {
    const GuardedValue v = guarded_value(guard.active.shown_mm[axis], guard.window_mm, guard.unit);
    lines.refuse_if(fmt::format("ABS[#{}+#{}-[{}]] GT {}", 5201 + axis, first_offset_variable(offset) + axis,
                                v.value, v.window),
                    fmt::format("{} {}", guard.active.name, "XYZ"[axis]));
  }
}

/// Geometry and wear of the length that H selects.
void check_length(const Guard& guard, const std::string& sum, MacroLines& lines) {
  if (!guard.length_mm) return;
  const GuardedValue v = guarded_value(*guard.length_mm, guard.window_mm, guard.unit);
  lines.refuse_if(fmt::format("ABS[{}-[{}]] GT {}", sum, v.value, v.window), "TOOL LENGTH");
}

}  // namespace

// LinuxCNC, "G Code Overview", section "Numbered Parameters": 5211-5219 are the G92 offset, which acts if
// 5210 is 1; 5220 is the number of the coordinate system, 1 to 9 for G54 to G59.3; 5221-5230 are X to W and R
// of G54, 5241-5250 those of G55, and so on, in units of the machine; 5400 is the tool in the spindle and
// 5403 its offset along Z, set by G43. Section "Predefined Named Parameters": #<_metric> is 1 under G21.
// Section "Messages": (abort, ) shows the text and stops the program. "O Codes", section "Conditional": if,
// endif.
std::vector<std::string> linuxcnc_guard(const Guard& guard) {
  LinuxcncLines lines(guard);
  const bool metric = guard.unit == LengthUnit::millimetres;
  lines.refuse_if("#<_metric> NE " + std::string(metric ? "1" : "0"),
                  fmt::format("THE UNIT MUST BE {}", metric ? "MM, G21" : "INCH, G20"));
  const int system = number_of_offset(guard.active.name).basic;
  lines.refuse_if(fmt::format("#5220 NE {}", system), guard.active.name + " MUST BE ACTIVE");
  if (!guard.program_shifts) lines.refuse_if("#5210 NE 0", "NO G92 OR G52 MAY ACT");
  for (int axis = 0; axis < 3; ++axis) {
    const GuardedValue v = guarded_value(guard.active.shown_mm[axis], guard.window_mm, guard.control);
    lines.refuse_if(fmt::format("ABS[#{} - [{}]] GT {}", 5201 + 20 * system + axis, v.value, v.window),
                    fmt::format("{} {} MUST BE {}", guard.active.name, "XYZ"[axis], v.range));
  }
  if (!guard.program_shifts) {
    const GuardedValue turn = guarded_turn(guard);
    lines.refuse_if(fmt::format("ABS[#{} - [{}]] GT {}", 5210 + 20 * system, turn.value, turn.window),
                    fmt::format("THE ROTATION OF {} MUST BE {}", guard.active.name, turn.range));
  }
  if (guard.tool > 0)
    lines.refuse_if(fmt::format("#5400 NE {}", guard.tool),
                    fmt::format("TOOL T{} MUST BE IN THE SPINDLE", guard.tool));
  if (guard.length_mm) {
    const GuardedValue v = guarded_value(*guard.length_mm, guard.window_mm, guard.control);
    lines.refuse_if(fmt::format("ABS[#5403 - [{}]] GT {}", v.value, v.window),
                    "THE TOOL LENGTH MUST BE " + v.range);
  }
  return lines.take();
}

std::string why_no_linuxcnc_guard(const Guard& guard) {
  return number_of_offset(guard.active.name).basic > 0
             ? why_no_guard_of_tilted(guard)
             : fmt::format("LinuxCNC has no work offset {}, leave out --guard", guard.active.name);
}

// FANUC, "Custom Macro", B-63014EN and B-64694EN, section "System variables": #3000 stops with an alarm and
// the comment behind it; #4006 is 20 or 21, #4014 is 54 to 59, #4130 is P of G54.1, #4111 is H and #4120 is
// T, of the blocks before; #5201 is the external workpiece zero point offset, #5221 that of G54, #5241 that
// of G55; #7001 to #7941 and #14001 on those of G54.1 P1 on, all in the unit of the program; with tool
// compensation memory C #2201 on are the lengths' geometry and #2001 on their wear. Section "Branch and
// repetition": IF [condition] THEN executes one statement.
std::vector<std::string> fanuc_guard(const Guard& guard) {
  MacroLines lines(guard);
  check_unit_and_offset(guard, lines);
  if (guard.tool > 0 && guard.is_chosen)  // else #4120 is the next tool
    lines.refuse_if(fmt::format("#4120 NE {}", guard.tool), fmt::format("TOOL T{}", guard.tool));
  check_length(guard, "#[2200+#4111]+#[2000+#4111]", lines);
  return lines.take();
}

std::string why_no_fanuc_guard(const Guard& guard) {
  const OffsetNumber offset = number_of_offset(guard.active.name);
  constexpr int most_basic = 6;
  if (offset.additional > 0 || (offset.basic > 0 && offset.basic <= most_basic)) return "";
  return fmt::format("no variable of the control has the work offset {}, leave out --guard",
                     guard.active.name);
}

// Haas, "Mill Operator's Manual", chapter "Macros", section "System Variables": #3000 is an alarm with its
// comment, #3026 the tool in the spindle, #4001 to #4021 the G codes of the last block by group, #4101 to
// #4126 its addresses (H is #4111), #5201 G52, #5221 to #5326 G54 to G59, #2001 to #2200 tool lengths and
// #2201 to #2400 their wear.
std::vector<std::string> haas_guard(const Guard& guard) {
  MacroLines lines(guard);
  check_unit_and_offset(guard, lines);
  if (guard.tool > 0)
    lines.refuse_if(fmt::format("#3026 NE {}", guard.tool), fmt::format("TOOL T{}", guard.tool));
  check_length(guard, "#[2000+#4111]+#[2200+#4111]", lines);
  return lines.take();
}

std::string why_no_haas_guard(const Guard& guard) {
  constexpr int most_basic = 6;
  const int basic = number_of_offset(guard.active.name).basic;
  if (basic > 0 && basic <= most_basic) return "";
  return fmt::format("guards for Haas check G54 to G59, not {}: leave out --guard", guard.active.name);
}

}  // namespace counterflex
