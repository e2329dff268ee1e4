#pragma once
/// Move instructions of INFORM: MOVJ C00001 VJ=50.00, MOVL C00002 V=66.7 PL=0, MOVC P00100 V=10.0 FPT.
#include <optional>
#include <string>
#include <string_view>

#include "program/robot/yaskawa/lex.hpp"

namespace counterflex {

struct JbiMotion {
  std::string head{};                  ///< MOVJ, MOVL, MOVC
  std::optional<JbiName> target{};     ///< C or P
  std::optional<JbiName> base{};       ///< BC
  std::optional<JbiName> station{};    ///< EC
  std::string computed_target{};       ///< LP000, P[I000]: its value is set at run time
  std::optional<double> speed_mm_s{};  ///< V; 0 for a variable and for VR and VE
  bool passes = true;                  ///< the robot does not stop at the target
  /// A word acts at the start or the end of the step: a copy of the instruction would repeat it.
  bool stays_whole = false;
  bool is_fixed_point = false;                 ///< FPT: a circle ends and the next one begins
  std::optional<RobotNumber> corner_radius{};  ///< CR, mm
  std::string why{};                           ///< why the step is not followed; empty if it is
};

/// Whether `word` (upper case) moves the robot: MOVJ, MOVL, MOVC, MOVS, IMOV, also of a second group (+MOVL)
/// or coordinated with a station (SMOVL).
/// The smallest CR.
constexpr double least_jbi_corner_mm = 0.1;

bool is_jbi_move(std::string_view word);

/// The words of MOVJ, MOVL or MOVC.
JbiMotion jbi_motion(std::string_view text, Span code);

}  // namespace counterflex
