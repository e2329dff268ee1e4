#include "program/robot/kuka/reader.hpp"

#include <utility>

#include "program/program_files.hpp"
#include "program/text/lex.hpp"

namespace counterflex {

// A B C are the angles of Rz(A) Ry(B) Rx(C). Between two targets the control turns the tool about one fixed
// axis by default ($ORI_TYPE=#VAR): KUKA System Software 8.x, Operating and Programming Instructions for
// System Integrators, "Orientation control LIN, CIRC".
KukaReader::KukaReader(const std::string& file, const ReadOptions& options, const Dialect& dialect,
                       Outline outline)
    : RobotReader(file, options, dialect, std::move(outline), krl_comment, OrientationForm::fixed_axes),
      krl_{.robot = reading(),
           .data_lists = this->outline().data_lists && !this->outline().list_follows_loop,
           .list_follows = this->outline().list_follows_loop,
           .arrays = this->outline().arrays,
           .facts = this->outline().krl} {}

/// The lines of each file have their own numbers.
bool KukaReader::next_line(RobotLine& line) const {
  if (!RobotReader::next_line(line)) return false;
  if (const auto number = number_behind_mark(part(program().text, line.code))) line.line = *number - 1;
  return true;
}

/// Folds and the parameters of inline forms are not names of operations, and neither are comments of a list.
void KukaReader::read_comment(const RobotLine& line) {
  const bool is_blank = empty(line.code) && empty(line.comment);
  const bool before_list = program().text.compare(line.line_end.end, file_mark.size(), file_mark) == 0;
  if (krl_.in_data_list || (is_blank && before_list)) return;
  const std::string comment = krl_word(part(program().text, line.comment));
  if (!comment.starts_with("FOLD") && !comment.starts_with("ENDFOLD")) RobotReader::read_comment(line);
}

}  // namespace counterflex
