#pragma once
/// Checks that a corrected program makes before its first cut, in the language of its control.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/program/program.hpp"

namespace counterflex {

/// A work offset, and the numbers that the control must have for it.
struct GuardedOffset {
  std::string name;                    ///< as in ProgramFrame; empty: the world frame of a robot
  Vector3 shown_mm = Vector3::Zero();  ///< on the control
  std::optional<Matrix3> R{};          ///< of the frame of a robot, in its world frame
};

/// What the checks compare. A program that fails one of them stops with an alarm.
struct Guard {
  GuardedOffset active;               ///< at the first cut
  double window_mm = 0;               ///< by how much an offset and the tool length may be off, by axis
  long tool = 0;                      ///< in the spindle; 0: not known, not checked
  std::optional<double> length_mm{};  ///< of the tool, if a length acts and the run knows it
  LengthUnit unit = LengthUnit::millimetres;  ///< of the program at the first cut
  /// The program shifts or turns its coordinates in the offset (G52, G92, G68).
  bool program_shifts = false;
  /// Of the offset of a machine tool about Z (deg, from -180 to 180). Empty: it is turned about X or Y, too.
  std::optional<double> turn_deg = 0;
  bool is_chosen = true;                         ///< the last T of the program is this tool
  LengthUnit control = LengthUnit::millimetres;  ///< of a control whose numbers do not depend on the program
};

/// By how much the angles of a robot's frame may be off (deg).
inline constexpr double guarded_angle_deg = 0.002;

/// The move of the first cut in a window: the first feed move or cycle. Null: it is not in this window.
const Move* first_cut(const Program& window);

/// Why programs of the dialect cannot have this guard; empty: they can.
std::string why_no_guard(const std::string& dialect, const Guard& guard);

/// What a guard of the dialect needs for itself and the text uses: a label, a register; empty: nothing.
std::string reserved_for_guard(const std::string& dialect, std::string_view text);

}  // namespace counterflex
