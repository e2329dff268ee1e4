#pragma once
/// Work offsets and tool data in the words of controls, rounded to the digits that are written. Poses in m.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/geometry/pose.hpp"
#include "counterflex/program/move.hpp"

namespace counterflex {

/// How a control writes numbers.
struct ControlWords {
  std::string_view dialect{};
  LengthUnit unit = LengthUnit::millimetres;  ///< of the program, where the control has the choice
  int decimals = -1;                          ///< of lengths; -1: as many as the control keeps
};

/// A length (m) rounded to the last digit that is written: 0.0001 mm, on Fanuc, Haas and GRBL controls and
/// robots 0.001 mm; 0.00001 and 0.0001 inch.
double rounded_length(const ControlWords& control, double length);

/// A work offset as the control gets it.
struct WrittenOffset {
  Pose X_MW;                         ///< of the written numbers
  std::string change{};              ///< what is added: "X-0.041 Y+0.012 mm"; "nothing"
  std::vector<std::string> words{};  ///< a line each; empty where nothing changes
};

/// The offset `name`, now at `X_MW`, moved by `shift` (X_MW becomes shift * X_MW). Where `turns` the angles
/// of the offset change, too, in the form of the robot language; else `shift` does not turn.
///
/// Fanuc: G90 G10 L2 P1 for G54, L20 P3 for G54.1 P3; Haas: L20 P3 for G154 P3. LinuxCNC: G10 L2 P1 to P9 for
/// G54 to G59.3. Sinumerik: $P_UIFR[1,X,TR] for G54. Klartext: a row of the preset table. KUKA: BASE_DATA or
/// $BASE. ABB: uframe and oframe of the work object. FANUC TP: UFRAME. URScript: the pose of a plane.
WrittenOffset written_offset(const ControlWords& control, const std::string& name, const Pose& X_MW,
                             const Pose& shift, bool turns);

/// A tool whose length and radius change (m). `length_now`, `radius_now`: what the control has, where it is
/// known.
struct ChangedTool {
  long number = 0;
  std::optional<double> length{}, radius{};
  std::optional<double> length_now{}, radius_now{};
};

/// The new values in the control's words, a line each. LinuxCNC: the tool table by G10 L1, where the present
/// values are known. Others: wear that is zero now. Fanuc: G10 L11 and L13, H and D of the tool's number;
/// Haas: G10 L11 alone, because radius or diameter is a setting; Sinumerik: $TC_DP12 and $TC_DP15 of edge 1;
/// Klartext: DL and DR of the tool table. Empty: the control has no words for it.
std::vector<std::string> tool_words(const ControlWords& control, const ChangedTool& tool);

}  // namespace counterflex
