#include "program/robot/ur/reader.hpp"

#include <utility>

#include "program/robot/ur/still_functions.hpp"

namespace counterflex {

UrReader::UrReader(const std::string& file, const ReadOptions& options, const Dialect& dialect,
                   Outline outline)
    : RobotReader(file, options, dialect, std::move(outline), ur_comment, OrientationForm::rotation_vector),
      ur_{reading()} {
  reading().state.unit = LengthUnit::metres;
}

void UrReader::read_statement(const RobotLine& line) {
  if (!names_are_known_) {
    ur_.names = ur_names(program().text);
    ur_.still_functions = ur_still_functions(ur_.names, reading().options.harmless_calls);
  }
  names_are_known_ = true;
  read_ur_statement(ur_, line);
}

}  // namespace counterflex
