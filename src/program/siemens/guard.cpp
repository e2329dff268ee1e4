#include "program/siemens/guard.hpp"

#include <fmt/format.h>

#include <charconv>

#include "program/guard/guard_mark.hpp"
#include "program/guard/guard_text.hpp"

namespace counterflex {
namespace {

/// The lines of a guard, with alarms from 65000 on.
class SiemensLines {
 public:
  explicit SiemensLines(const Guard& guard) { lines_.push_back("; " + guard_title(guard)); }

  void refuse_if(const std::string& condition, const std::string& message) {
    constexpr int first_alarm = 65000;
    lines_.push_back(marked_line(fmt::format("IF {} ; ", condition), ""));
    lines_.push_back(marked_line(
        fmt::format("SETAL({},\"COUNTERFLEX GUARD: {}\") ; ", first_alarm + count_++, message), ""));
    lines_.push_back(marked_line("ENDIF ; ", ""));
  }

  std::vector<std::string> take() { return std::move(lines_); }

 private:
  std::vector<std::string> lines_;
  int count_ = 0;
};

/// Of the settable frame: G54 is 1, G57 is 4, G505 is 5; 0: none.
int frame_number(std::string_view name) {
  constexpr int first = 53, most_short = 57, first_long = 500;
  int number = 0;
  if (name.empty() || name[0] != 'G') return 0;
  std::from_chars(name.data() + 1, name.data() + name.size(), number);
  if (number > first && number <= most_short) return number - first;
  return number > first_long + 4 ? number - first_long : 0;
}

}  // namespace

// SINUMERIK 840D sl / 828D, "Job Planning" (6FC5398-2BP40), sections "Check structures" (IF, ENDIF) and
// "Alarms (SETAL)": the numbers 65000 to 69999 are for users, and stop the program until RESET. "System
// Variables" (6FC5397-6AP40): $P_GG[13] is the G code of the unit (1 G70, 2 G71, 3 G700, 4 G710), $P_UIFRNUM
// the number of the active settable frame, $P_IFRAME that frame, $P_PFRAME the programmable one (TRANS),
// $P_TOOLNO the tool number and $P_TOOLL[1] its length. "Frame components": TR and FI are the coarse and the
// fine offset, RT the rotation. With G70 and G71 lengths of frames and tools are in the basic system, with
// G700 and G710 in that of the program: `why_no_siemens_guard` requires that both are the same.
std::vector<std::string> siemens_guard(const Guard& guard) {
  SiemensLines lines(guard);
  const bool metric = guard.unit == LengthUnit::millimetres;
  lines.refuse_if(fmt::format("($P_GG[13]<>{}) AND ($P_GG[13]<>{})", metric ? 2 : 1, metric ? 4 : 3),
                  fmt::format("THE UNIT MUST BE {}", metric ? "MM, G71" : "INCH, G70"));
  lines.refuse_if(fmt::format("$P_UIFRNUM<>{}", frame_number(guard.active.name)),
                  guard.active.name + " MUST BE ACTIVE");
  for (int axis = 0; axis < 3; ++axis) {
    const char name = "XYZ"[axis];
    const GuardedValue v = guarded_value(guard.active.shown_mm[axis], guard.window_mm, guard.unit);
    lines.refuse_if(
        fmt::format("ABS($P_IFRAME[{0},TR]+$P_IFRAME[{0},FI]-({1}))>{2}", name, v.value, v.window),
        fmt::format("{} {} MUST BE {}", guard.active.name, name, v.range));
  }
  if (!guard.program_shifts) {
    const GuardedValue turn = guarded_turn(guard);
    lines.refuse_if(fmt::format("ABS($P_IFRAME[X,RT])+ABS($P_IFRAME[Y,RT])+ABS($P_IFRAME[Z,RT]-({}))>{}",
                                turn.value, turn.window),
                    fmt::format("THE ROTATION OF {} MUST BE {}", guard.active.name, turn.range));
    lines.refuse_if("ABS($P_PFRAME[X,TR])+ABS($P_PFRAME[Y,TR])+ABS($P_PFRAME[Z,TR])>0.001",
                    "NO TRANS MAY ACT");
  }
  if (guard.tool > 0)
    lines.refuse_if(fmt::format("$P_TOOLNO<>{}", guard.tool),
                    fmt::format("TOOL T{} MUST BE ACTIVE", guard.tool));
  if (guard.length_mm) {
    const GuardedValue v = guarded_value(*guard.length_mm, guard.window_mm, guard.unit);
    lines.refuse_if(fmt::format("ABS($P_TOOLL[1]-({}))>{}", v.value, v.window),
                    "THE TOOL LENGTH MUST BE " + v.range);
  }
  return lines.take();
}

std::string why_no_siemens_guard(const Guard& guard) {
  if (frame_number(guard.active.name) == 0)
    return fmt::format(
        "{} is not a settable frame of the control (G54 to G57, G505 to G599): leave out --guard",
        guard.active.name);
  if (guard.unit != guard.control)
    return "the program and the control have different units, and G70, G71, G700 and G710 differ in the unit "
           "of "
           "offsets: state `units` of [program] as it is on the control, or leave out --guard";
  return why_no_guard_of_tilted(guard);
}

}  // namespace counterflex
