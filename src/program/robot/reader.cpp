#include "program/robot/reader.hpp"

#include <utility>

#include "program/text/lex.hpp"

namespace counterflex {

RobotReader::RobotReader(const std::string& file, const ReadOptions& options, const Dialect& dialect,
                         Outline outline, std::string_view comment_mark, OrientationForm form)
    : BlockReader(file, options, dialect, std::move(outline)),
      reading_{program(), this->options(), form},
      comment_mark_(comment_mark) {}

bool RobotReader::read_block() {
  if (reading_.ended || !next_line(line_)) return false;
  read_comment(line_);
  if (empty(line_.code)) return true;
  ++program().block_count;
  refuse_conflict_marker(reading_, line_);
  read_statement(line_);
  // A call may move the robot away from joint values.
  RobotState& state = reading_.state;
  const bool calls = part(program().text, line_.code).find('(') != std::string_view::npos;
  if (state.joints && state.joints_line != line_.line && calls) state.joints.reset();
  return true;
}

bool RobotReader::next_line(RobotLine& line) const {
  return next_robot_line(program().text, comment_mark_, line);
}

void RobotReader::read_comment(const RobotLine& line) {
  read_robot_comment(reading_, line);
}

bool RobotReader::may_end_before(const Move& last, bool anywhere) const {
  const bool across = last.words[0] || last.words[1] || anywhere;
  return across && all_known(last.known_start) && !last.arc && !last.block_delete &&
         last.handling == Handling::own && reading_.open_bodies == 0;
}

void RobotReader::resume_behind(std::size_t read) {
  reading_.operation.begin_window(program());
  line_.line_end = {read, read};
}

bool is_corrected_robot_program(std::string_view text, std::string_view comment_mark) {
  constexpr int most_lines_before_header = 64;
  RobotLine line;
  while (line.line < most_lines_before_header && next_robot_line(text, comment_mark, line))
    if (empty(line.code) && is_header_comment(part(text, line.comment))) return true;
  return false;
}

}  // namespace counterflex
