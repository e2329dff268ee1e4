#include "program/robot/yaskawa/read.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "program/text/lex.hpp"

namespace counterflex {
namespace {

/// Instructions that do not move the robot.
constexpr auto motionless = std::to_array<std::string_view>(
    {"NOP",     "DOUT",    "DIN",     "AOUT",    "AIN",     "WAIT",    "PULSE",   "TIMER",  "PAUSE",
     "SET",     "SETE",    "GETE",    "GETS",    "ADD",     "SUB",     "MUL",     "DIV",    "INC",
     "DEC",     "AND",     "OR",      "NOT",     "XOR",     "CLEAR",   "SQRT",    "SIN",    "COS",
     "ATAN",    "CNVRT",   "MFRAME",  "MULMAT",  "INVMAT",  "MSHIFT",  "GETPOS",  "GETARG", "GETFILE",
     "SETREG",  "GETREG",  "GETTOOL", "MSG",     "CWAIT",   "ADVINIT", "ADVSTOP", "DIALOG", "SETUALM",
     "ARATION", "ARATIOF", "PRINT",   "VAL",     "VAL2STR", "STR2VAL", "MID$",    "LEN",    "ASC",
     "CHR$",    "CAT$",    "TOOLON",  "TOOLOF",  "ARCSET",  "AWELD",   "VWELD",   "COMM",   "QUE",
     "ONLVOL",  "REFP",    "CLS",     "DIALOGP", "ARCON",   "ARCOF"});

/// The robot may be anywhere: behind a label, a call.
void forget(JbiReading& r) {
  forget_position(r.robot);
  r.robot.state.external = {};
  r.robot.state.moved_by_machine = true;
}

/// A jump may lead here from anywhere.
void read_label(JbiReading& r) {
  forget(r);
  r.speed_mm_s = 0;
  r.is_shifted = r.is_shifted || r.job->shifts;
}

/// "SPINDLE_ON" of "CALL JOB:SPINDLE_ON", and the name of a macro.
std::string_view called_job(const JbiReading& r, const RobotLine& line) {
  constexpr std::string_view job = "JOB:";
  const std::string_view text = r.robot.program.text;
  const auto words = jbi_words(text, line.code);
  for (const Span& word : words)
    if (const auto name = part(text, word); name.starts_with(job)) return name.substr(job.size());
  return part(text, words.front());
}

void read_call(JbiReading& r, const RobotLine& line, std::string_view what) {
  if (is_stated_harmless(r.robot, line, called_job(r, line))) return;
  forget(r);
  r.speed_mm_s = 0;
  if (r.call_line == 0) r.call_line = line.line;
  note_unread_call(r.robot, line, fmt::format("'{}' may move the robot", what));
}

/// SETTOOL TL#(1) P001, SETFILE TOOL#(1).X 5: other numbers of a tool move its centre.
void read_tool_numbers(JbiReading& r, const RobotLine& line, std::string_view head) {
  const bool is_tool =
      head == "SETTOOL" || jbi_word(part(r.robot.program.text, line.code)).find("TOOL#") != std::string::npos;
  if (!is_tool) return;
  r.tool.reset();
  enter_robot_tool(r.robot, 0);
}

/// SPEED V=100: for the steps behind it that have no speed.
void read_speed(JbiReading& r, const RobotLine& line) {
  const JbiMotion words = jbi_motion(r.robot.program.text, line.code);
  if (words.speed_mm_s) r.speed_mm_s = r.robot.open_bodies > 0 ? 0 : *words.speed_mm_s;
}

/// SFTON shifts the positions of the steps up to SFTOF.
void read_shift(JbiReading& r, bool on) {
  r.is_shifted = on || (r.is_shifted && r.robot.open_bodies > 0);
}

void read_flow(JbiReading& r, const RobotLine& line, JbiFlow flow) {
  int& bodies = r.robot.open_bodies;
  switch (flow) {
    case JbiFlow::body_begin:
      ++bodies;
      break;
    case JbiFlow::body_end:
      bodies = std::max(bodies - 1, 0);
      break;
    case JbiFlow::label:
      return read_label(r);
    case JbiFlow::call:
      return read_call(r, line, part(r.robot.program.text, line.code));
    case JbiFlow::end:
      r.robot.ended = true;
      break;
    case JbiFlow::branch:
    case JbiFlow::jump:
    case JbiFlow::none:
      break;
  }
}

/// ///ATTR SC,RW,RJ and ////FRAME USER 2: of a relative job all positions are in one frame.
void read_attribute(JbiReading& r, const RobotLine& line) {
  const std::string_view text = r.robot.program.text;
  const std::vector<Span> words = jbi_words(text, line.code);
  const std::string head = jbi_word(part(text, words.front()));
  if (head == "///ATTR") r.is_relative = jbi_word(part(text, line.code)).ends_with(",RJ");
  if (head != "////FRAME" || !r.is_relative || words.size() < 3) return;
  if (jbi_word(part(text, words[1])) != "USER") return;
  long user = -1;
  std::from_chars(text.data() + words[2].begin, text.data() + words[2].end, user);
  for (const JbiPosition& position : r.job->positions.list) {
    const JbiSection& section = r.job->positions.sections[position.section];
    if (section.type != "USER" || section.user == user) continue;
    refuse(
        r.robot.program.file, line, words[2].begin,
        fmt::format("the frame of this relative job is USER {}, but the position in line {} is in USER {}; "
                    "use one user coordinate system",
                    user, jbi_line_number(text, position.line_begin), *section.user));
  }
}

/// The numbers of positions in an instruction change when positions are inserted.
void keep_numbers(JbiReading& r, const RobotLine& line) {
  for (const JbiName& name : jbi_names(r.robot.program.text, line.code))
    if (!is_variable(name.family)) r.numbers.push_back(name.digits);
}

}  // namespace

void read_jbi_statement(JbiReading& r, const RobotLine& line) {
  const std::string_view text = r.robot.program.text;
  if (!r.job) {
    r.job = jbi_job(text, r.robot.program.file);
    r.followed.resize(r.job->positions.list.size());
  }
  if (line.code.begin < r.job->positions.end) return;
  if (text[line.code.begin] == '/') return read_attribute(r, line);
  keep_numbers(r, line);
  const Span head_span = jbi_words(text, line.code).front();
  const std::string head = jbi_word(part(text, head_span));
  if (is_jbi_move(head)) return read_jbi_move(r, line);
  if (const JbiFlow flow = jbi_flow(head); flow != JbiFlow::none) return read_flow(r, line, flow);
  if (head == "SETTOOL" || head == "SETFILE") return read_tool_numbers(r, line, head);
  if (head == "SPEED") return read_speed(r, line);
  if (head.ends_with("SFTON") || head.ends_with("SFTOF")) return read_shift(r, head.ends_with("SFTON"));
  if (is_among(head, motionless)) return;
  read_call(r, line, part(text, head_span));
}

}  // namespace counterflex
