#include "program/robot/yaskawa/reader.hpp"

#include <utility>

#include "program/text/lex.hpp"

namespace counterflex {

// Rx Ry Rz are degrees about the fixed axes X, Y, Z, one after the other: R = Rz Ry Rx. RoboDK API reference,
// robomath, Pose_2_Motoman; YASKAWA NX100, "Job Data Format", RECTAN gives their order.
YaskawaReader::YaskawaReader(const std::string& file, const ReadOptions& options, const Dialect& dialect,
                             Outline outline)
    : RobotReader(file, options, dialect, std::move(outline), jbi_comment, OrientationForm::fixed_axes),
      jbi_{.robot = reading()} {}

bool YaskawaReader::read_block() {
  const bool more = RobotReader::read_block() && !has_ended();
  if (!more && program().counts.empty()) program().counts = jbi_counts(jbi_);
  return more;
}

/// Above the instructions, an apostrophe is not a comment.
void YaskawaReader::read_comment(const RobotLine& line) {
  if (jbi_.job && line.span.begin >= jbi_.job->positions.end) RobotReader::read_comment(line);
}

bool is_corrected_job(std::string_view text) {
  RobotLine line;
  bool inside = false;
  while (next_robot_line(text, jbi_comment, line)) {
    const std::string_view code = part(text, line.code);
    if (inside && code.empty() && is_header_comment(part(text, line.comment))) return true;
    if (inside && !code.empty() && code.front() != '/' && jbi_word(code) != "NOP") return false;
    inside = inside || jbi_word(code).starts_with("//INST");
  }
  return false;
}

}  // namespace counterflex
