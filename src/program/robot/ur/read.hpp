#pragma once
/// Reads the statements of URScript.
#include <string>

#include "program/robot/reading.hpp"
#include "program/robot/ur/names.hpp"

namespace counterflex {

struct UrReading {
  RobotReading& robot;
  UrNames names{};  ///< of the whole text
  UrFunctions still_functions{};
  bool begun = false;         ///< the function that is the program has begun
  std::string tool{};         ///< pose of the last set_tcp, or an expression of it
  bool unknown_zone = false;  ///< the blend radius at the last target is computed at run time
};

/// Reads the statement of `line`. Throws `InputError` with line and column.
void read_ur_statement(UrReading& reading, const RobotLine& line);

/// The pose in mm.
Pose ur_pose_mm(const UrPose& pose);

/// movej, movel, movep, movec.
void read_ur_motion(UrReading& reading, const RobotLine& line, const UrCall& call);

/// Whether the statement is in a loop, a condition, a thread or a function of the program.
inline bool in_body(const UrReading& reading) {
  return reading.robot.open_bodies > 0;
}

}  // namespace counterflex
