#include "program/robot/kuka/reader.hpp"

#include <utility>

#include "program/text/lex.hpp"

namespace counterflex {

// A B C are the angles of Rz(A) Ry(B) Rx(C). Between two targets the control turns the tool about one fixed
// axis by default ($ORI_TYPE=#VAR): KUKA System Software 8.x, Operating and Programming Instructions for
// System Integrators, "Orientation control LIN, CIRC".
KukaReader::KukaReader(const std::string& file, const ReadOptions& options, const Dialect& dialect,
                       Outline outline)
    : RobotReader(file, options, dialect, std::move(outline), krl_comment, OrientationForm::fixed_axes),
      krl_{.robot = reading(), .data_lists = this->outline().data_lists, .arrays = this->outline().arrays} {}

/// Folds and the parameters of inline forms are not names of operations.
void KukaReader::read_comment(const RobotLine& line) {
  const std::string comment = krl_word(part(program().text, line.comment));
  if (!comment.starts_with("FOLD") && !comment.starts_with("ENDFOLD")) RobotReader::read_comment(line);
}

}  // namespace counterflex
