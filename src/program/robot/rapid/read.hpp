#pragma once
/// Reads the statements of ABB RAPID.
#include <map>
#include <string>

#include "program/robot/rapid/data.hpp"
#include "program/robot/reading.hpp"

namespace counterflex {

struct RapidReading {
  RobotReading& robot;
  const bool whole;  ///< the text is the whole module
  RapidModule module{};
  bool scanned = false;
  std::size_t behind = 0;  ///< of a whole text: behind the last statement
  bool in_function = false;
  bool scaled_speed = false;             ///< VelSet changes all speeds
  bool any_configuration = false;        ///< ConfL\Off: the control does not compare confdata on lines
  bool any_joint_configuration = false;  ///< ConfJ\Off: the control does not compare confdata on joint moves
  std::string configuration{};           ///< confdata of the last followed target
  bool locks_axis = false;               ///< SingArea\LockAxis4
  std::string tool{};                    ///< of the last followed motion, in upper case
  std::string circle_path{};             ///< CirPathMode in upper case: "\OBJECTFRAME"; empty: the default
  std::map<std::string, std::string, std::less<>> spellings{};  ///< of work objects, by upper case
};

/// Reads the statements that begin in `line`. Throws `InputError` with line and column.
void read_rapid_line(RapidReading& reading, const RobotLine& line);

/// MoveL, MoveC, MoveJ.
void read_rapid_motion(RapidReading& reading, const RobotLine& line, const RapidStatement& statement);

}  // namespace counterflex
