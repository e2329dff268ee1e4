#include "program/robot/rapid/reader.hpp"

#include <utility>

namespace counterflex {

// A quaternion is q1 q2 q3 q4 = w x y z: ABB, RAPID Instructions, Functions and Data types, 3HAC16581,
// "orient". Along a line the control turns the tool from one target to the next about one fixed axis, evenly:
// ABB, RAPID Overview, 3HAC16580, "Interpolation of the position and orientation of the tool".
RapidReader::RapidReader(const std::string& file, const ReadOptions& options, const Dialect& dialect,
                         Outline outline)
    : RobotReader(file, options, dialect, std::move(outline), rapid_comment, OrientationForm::quaternion),
      rapid_{reading(), this->outline().named_targets,
             RapidModule(this->outline().routines, this->outline().still_routines)} {}

/// Points inserted into `last` limit the zone at its start, which is written in the same window.
bool RapidReader::may_end_before(const Move& last, bool anywhere) const {
  const bool limits_zone = rapid_.robot.began_in_zone && (last.may_split || last.may_jump);
  return !limits_zone && RobotReader::may_end_before(last, anywhere);
}

}  // namespace counterflex
