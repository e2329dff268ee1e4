#pragma once
/// Reads the statements of APT.
#include "program/robot/apt/lex.hpp"
#include "program/robot/reading.hpp"

namespace counterflex {

/// A circle on which the next points lie.
struct AptCircle {
  Vector3 centre_mm;
  Vector3 normal;
  bool is_known = false;              ///< its numbers are plain
  std::optional<double> radius_mm{};  ///< of the first point behind CIRCLE/; empty before that point
};

struct AptReading {
  RobotReading& robot;
  std::optional<LengthUnit> unit{};   ///< of UNITS/ or of the options
  bool rapid = false;                 ///< RAPID: the next point is reached in rapid
  std::optional<AptCircle> circle{};  ///< CIRCLE/, until a point that is not on it
  bool in_cycle = false;              ///< CYCLE/: the points are holes
  bool in_cutcom = false;             ///< CUTCOM/: the control shifts the points
  bool may_skip = false;              ///< OPSKIP/ON: the control may skip the statements
  std::optional<double> feed_per_turn_mm{};
  std::vector<std::string> systems{};  ///< texts of the coordinate systems without a name, in their order
};

/// Reads the statement of `line`. Throws `InputError` with line and column.
void read_apt_statement(AptReading& reading, const RobotLine& line);

/// GOTO/x,y,z and GOTO/x,y,z,i,j,k
void read_apt_point(AptReading& reading, const RobotLine& line, const AptStatement& statement);

/// CIRCLE/x,y,z,i,j,k,radius
void read_apt_circle(AptReading& reading, const AptStatement& statement);

/// The plain number that `parameter` is; empty for another.
std::optional<RobotNumber> apt_number(std::string_view text, Span parameter);

}  // namespace counterflex
