#pragma once
/// The text of a guard, from the language of the program.
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/program/guard.hpp"

namespace counterflex {

/// How a language writes guards.
struct GuardLanguage {
  std::string_view dialect;
  /// The lines, without line ends.
  std::vector<std::string> (*lines)(const Guard& guard);
  /// Why it cannot write this guard; empty: it can.
  std::string (*why_not)(const Guard& guard);
  std::vector<std::string_view> reserved{};  ///< what a program with a guard must not use
};

/// Lines of `guard`, each with `line_begin` and `line_end`. The dialect must have guards.
std::string guard_text(const std::string& dialect, const Guard& guard, const std::string& line_end,
                       const std::string& line_begin = "");

/// At most six decimals, without zeros at the end.
std::string guard_number(double value);

/// A value that the control must have, in its unit.
struct GuardedValue {
  std::string value;
  std::string window;  ///< rounded down
  std::string range;   ///< "119.5 TO 120.5 MM"
};
GuardedValue guarded_value(double mm, double window_mm, LengthUnit unit);

/// The same of the turn of an offset about Z, which has one.
GuardedValue guarded_turn(const Guard& guard);

/// Why an offset that is turned about X or Y has no guard; empty for others.
std::string why_no_guard_of_tilted(const Guard& guard);

/// "CORRECTED FOR G54 X120 Y80 Z-250 MM": the first line of a guard.
std::string guard_title(const Guard& guard);

/// G54 is 1, G59.3 of LinuxCNC is 9, "G54.1 P3" is 3 of the additional ones; 0: neither.
struct OffsetNumber {
  int basic = 0, additional = 0;
};
OffsetNumber number_of_offset(std::string_view name);

}  // namespace counterflex
