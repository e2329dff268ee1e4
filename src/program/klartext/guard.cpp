#include "program/klartext/guard.hpp"

#include <fmt/format.h>

#include "program/guard/guard_mark.hpp"
#include "program/guard/guard_text.hpp"

namespace counterflex {
namespace {

/// The lines of a guard. Its parameters are Q1990 to Q1993, its labels CFGUARD1 on.
class KlartextLines {
 public:
  explicit KlartextLines(const Guard& guard) { lines_.push_back("; " + guard_title(guard)); }

  void add(const std::string& statement) { lines_.push_back(marked_line(statement + " ; ", "")); }

  /// `condition` of Q1991 must hold: FN 9 "EQU +3", FN 12 "LT +0.5".
  void require(int function, const std::string& condition, int error, const std::string& what) {
    const std::string label = fmt::format("\"CFGUARD{}\"", ++count_);
    lines_.push_back("; COUNTERFLEX 1 GUARD: " + what);
    add(fmt::format("FN {}: IF +Q1991 {} GOTO LBL {}", function, condition, label));
    add(fmt::format("FN 14: ERROR = {}", error));
    add("LBL " + label);
  }

  std::vector<std::string> take() { return std::move(lines_); }

 private:
  std::vector<std::string> lines_;
  int count_ = 0;
};

constexpr int wrong_start = 1005, wrong_input = 1011;  // "Start position incorrect", "Input value incorrect"

void require_within(const GuardedValue& v, const std::string& what, int error, KlartextLines& lines) {
  lines.add(fmt::format("Q1991 = ABS ( Q1991 - ( {} ) )", v.value));
  lines.require(12, "LT +" + v.window, error, fmt::format("{} MUST BE {}", what, v.range));
}

}  // namespace

// HEIDENHAIN TNC 640 and TNC7, User's Manual "Klartext Programming", chapter "Programming Q parameters": FN 9
// and FN 12 jump if two values are equal, or the first is less; FN 14: ERROR stops with the text of its
// number; FN 18: SYSREAD reads system data, lengths always in mm. Appendix "System data": ID530 NR1 is the
// active row of the preset table, ID507 NR(row) IDX1 to IDX3 its X, Y, Z and IDX6 its SPC, ID220 NR2 IDX1 to
// IDX3 the active datum shift, ID20 NR1 the active tool, ID200 NR2 IDX1 its active length. Q1600 to Q1999 are
// free for users. The unit is that of BEGIN PGM and cannot differ.
std::vector<std::string> klartext_guard(const Guard& guard) {
  KlartextLines lines(guard);
  constexpr LengthUnit always = LengthUnit::millimetres;
  lines.add("FN 18: SYSREAD Q1990 = ID530 NR1");
  for (int axis = 0; axis < 3; ++axis) {
    lines.add(fmt::format("FN 18: SYSREAD Q1991 = ID507 NRQ1990 IDX{}", axis + 1));
    require_within(guarded_value(guard.active.shown_mm[axis], guard.window_mm, always),
                   fmt::format("PRESET {}", "XYZ"[axis]), wrong_start, lines);
  }
  if (!guard.program_shifts) {
    lines.add("FN 18: SYSREAD Q1991 = ID507 NRQ1990 IDX6");
    require_within(guarded_turn(guard), "PRESET SPC", wrong_start, lines);
    for (int axis = 0; axis < 3; ++axis)
      lines.add(fmt::format("FN 18: SYSREAD Q{} = ID220 NR2 IDX{}", 1991 + axis, axis + 1));
    lines.add("Q1991 = ABS Q1991 + ABS Q1992 + ABS Q1993");
    lines.require(9, "EQU +0", wrong_start, "NO DATUM SHIFT MAY ACT");
  }
  if (guard.tool > 0) {
    lines.add("FN 18: SYSREAD Q1991 = ID20 NR1");
    lines.require(9, fmt::format("EQU +{}", guard.tool), wrong_input,
                  fmt::format("TOOL {} MUST BE ACTIVE", guard.tool));
  }
  if (guard.length_mm) {
    lines.add("FN 18: SYSREAD Q1991 = ID200 NR2 IDX1");
    require_within(guarded_value(*guard.length_mm, guard.window_mm, always), "TOOL LENGTH", wrong_input,
                   lines);
  }
  return lines.take();
}

std::string why_no_klartext_guard(const Guard& guard) {
  return why_no_guard_of_tilted(guard);
}

}  // namespace counterflex
