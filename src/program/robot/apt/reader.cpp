#include "program/robot/apt/reader.hpp"

#include <utility>

namespace counterflex {

// A point has a tool axis, or keeps the last one; a program without any axis gives positions alone. The axis
// turns in the plane of two axes: ISO 4342, multiaxis output.
AptReader::AptReader(const std::string& file, const ReadOptions& options, const Dialect& dialect,
                     Outline outline)
    : RobotReader(file, options, dialect, std::move(outline), apt_comment, OrientationForm::axis),
      apt_{.robot = reading(), .unit = options.unit} {
  reading().turns = this->outline().tool_axes;
}

}  // namespace counterflex
