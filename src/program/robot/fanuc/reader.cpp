#include "program/robot/fanuc/reader.hpp"

#include <utility>

#include "counterflex/files/input_error.hpp"
#include "program/text/lex.hpp"
#include "program/text/operation.hpp"

namespace counterflex {

// W P R are angles about the fixed axes X, Y, Z of the frame: R = Rz(R) Ry(P) Rx(W). Along L the control
// turns the tool from one target to the next about one axis.
FanucReader::FanucReader(const std::string& file, const ReadOptions& options, const Dialect& dialect,
                         Outline outline)
    : RobotReader(file, options, dialect, std::move(outline), tp_comment, OrientationForm::fixed_axes),
      tp_{.robot = reading()} {}

bool FanucReader::next_line(RobotLine& line) const {
  if (next_tp_line(program().text, tp_.section, line)) return true;
  if (tp_.section == TpSection::attributes)
    throw InputError(ErrorKind::program_text, {program().file, 1, 1},
                     "the program has no line /MN, behind which the motions are; is the file cut off?");
  return false;
}

/// The number of the line is one of the program's counts.
void FanucReader::read_comment(const RobotLine& line) {
  if (tp_.section != TpSection::statements) return;
  const std::string_view text = program().text;
  if (const auto number = tp_line_number(text, line.span)) program().counts.push_back(number->field);
  RobotReader::read_comment(line);
}

bool is_corrected_tp_program(std::string_view text) {
  RobotLine line;
  for (TpSection section = TpSection::attributes; next_tp_line(text, section, line);) {
    if (const auto next = tp_section(part(text, line.span)))
      section = *next;
    else if (section == TpSection::statements)
      return empty(line.code) && is_header_comment(part(text, line.comment));
    if (section == TpSection::positions || section == TpSection::end) break;
  }
  return false;
}

}  // namespace counterflex
