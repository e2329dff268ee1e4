#include "program/robot/fanuc/read.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

using Words = std::span<const std::string_view>;

/// Begins of statements, in upper case without blanks.
constexpr auto motionless =
    std::to_array<std::string_view>({"DO[",          "DI[",         "RO[",
                                     "RI[",          "AO[",         "AI[",
                                     "GO[",          "GI[",         "SO[",
                                     "SI[",          "UO[",         "UI[",
                                     "WO[",          "WI[",         "WSO[",
                                     "WSI[",         "R[",          "SR[",
                                     "AR[",          "F[",          "M[",
                                     "VR[",          "PL[",         "$",
                                     "TIMER[",       "TIMER_",      "OVERRIDE=",
                                     "WAIT",         "MESSAGE[",    "UALM[",
                                     "PAYLOAD[",     "JMPLBL[",     "RSR[",
                                     "RUN",          "ABORT",       "PAUSE",
                                     "ARCSTART",     "ARCEND",      "WELDSTART",
                                     "WELDEND",      "COLDETECT",   "COLGUARD",
                                     "LOCKPREG",     "UNLOCKPREG",  "SKIPCONDITION",
                                     "MONITOR",      "JOINT_MAX_",  "LINEAR_MAX_SPEED",
                                     "VISIONRUN_",   "VISIONGET_",  "CLEAR",
                                     "ERROR_PROG=",  "RESUME_PROG", "MAINT_PROG=",
                                     "RETURN_PATH_", "STRLEN",      "TPSHOW",
                                     "LOCKVREG",     "UNLOCKVREG",  "TPUSRPRG"});
/// Begins of statements that move the tool away from the programmed targets.
constexpr auto displacing = std::to_array<std::string_view>(
    {"OFFSETCONDITION", "TOOL_OFFSETCONDITION", "VOFFSETCONDITION", "WEAVE", "TRACK", "SEARCH", "TOUCHOFFSET",
     "LINE[", "DEFENC", "SETTRIG", "SELBOUND", "STOP_TRACKING", "TRKENC"});

bool begins_with_any(std::string_view statement, Words begins) {
  return std::ranges::any_of(begins, [&](std::string_view begin) { return statement.starts_with(begin); });
}

/// Without the colon and the number.
std::string_view shown(const TpReading& r, const RobotLine& line) {
  return part(r.robot.program.text, line.code);
}

void read_call(TpReading& r, const RobotLine& line) {
  forget_tp_state(r);
  forget_tp_frames(r, line.line);
  note_uncorrected(r.robot, line, fmt::format("'{}' may move the robot", shown(r, line)));
}

/// Position behind the last comma of "IF R[1]=2,PR[1,2]=5" that is outside of brackets.
std::size_t behind_condition(std::string_view statement) {
  std::size_t behind = 0;
  int depth = 0;
  for (std::size_t at = 0; at < statement.size(); ++at) {
    const char c = statement[at];
    if (c == '[' || c == '(') ++depth;
    if (c == ']' || c == ')') --depth;
    if (c == ',' && depth == 0) behind = at + 1;
  }
  return behind;
}

/// A statement that runs under a condition: a jump, a call or an assignment.
void read_conditional(TpReading& r, const RobotLine& line, const std::string& statement) {
  if (statement.find("CALL") != std::string::npos) return read_call(r, line);
  ++r.robot.open_bodies;
  read_tp_assignment(r, line, statement.substr(behind_condition(statement)));
  --r.robot.open_bodies;
}

/// Loops and conditions; false for another statement.
bool read_flow(TpReading& r, const RobotLine& line, const std::string& statement) {
  int& open = r.robot.open_bodies;
  const bool begins =
      statement.starts_with("FOR") || (statement.starts_with("IF") && statement.ends_with("THEN"));
  if (begins) return ++open, true;
  if (statement == "ENDIF" || statement == "ENDFOR") return open = std::max(open - 1, 0), true;
  if (statement == "ELSE" || statement == "END") return true;
  const bool conditional = statement.starts_with("IF") || statement.starts_with("SELECT") ||
                           statement.starts_with("=") || statement.starts_with("ELSE,");
  if (conditional) read_conditional(r, line, statement);
  return conditional;
}

void read_statement(TpReading& r, const RobotLine& line) {
  const std::string_view text = r.robot.program.text;
  if (shown(r, line).starts_with("//")) return;  // is not executed
  if (const TpMotion motion = tp_motion(text, line.code); motion.type != 0)
    return read_tp_motion(r, line, motion);
  const std::string statement = tp_word(shown(r, line));
  if (begins_with_any(statement, displacing))
    refuse(r.robot.program.file, line, line.code.begin,
           fmt::format("'{}' moves the tool away from the programmed targets at run time, which is not "
                       "supported; post the job without it",
                       shown(r, line)));
  if (statement.starts_with("P["))
    refuse(r.robot.program.file, line, line.code.begin,
           "a position of /POS is computed at run time, which is not supported; write its numbers into /POS");
  if (statement.starts_with("LBL[")) {  // a jump may lead to it
    forget_tp_state(r);
    return forget_tp_frames_at_label(r, line.line);
  }
  if (read_tp_assignment(r, line, statement) || read_flow(r, line, statement)) return;
  if (!begins_with_any(statement, motionless)) read_call(r, line);
}

/// Positions whose uses are all targets of followed moves go with these moves: they are not other text.
void list_positions(TpReading& r) {
  std::vector<Span> spans;
  for (const auto& [number, position] : r.file.positions)
    if (position.followed > 0 && position.followed == position.uses) spans.push_back(position.span);
  std::ranges::sort(spans, {}, &Span::begin);
  auto& counts = r.robot.program.counts;
  counts.insert(counts.end(), spans.begin(), spans.end());
}

void begin_section(TpReading& r, TpSection section) {
  Program& program = r.robot.program;
  if (!r.scanned) r.file = tp_file(program.file, program.text);
  r.scanned = true;
  if (section == TpSection::statements && r.file.line_count) program.counts.push_back(*r.file.line_count);
  if (section == TpSection::positions) list_positions(r);
  r.section = section;
  r.robot.ended = section == TpSection::end;
}

}  // namespace

void forget_tp_state(TpReading& r) {
  forget_position(r.robot);
  r.robot.state.external = {};
  r.robot.state.moved_by_machine = true;
  r.frame.reset();
  r.selects_no_frame = false;
  r.tool.reset();
  r.registers.clear();
}

void read_tp_line(TpReading& r, const RobotLine& line) {
  Program& program = r.robot.program;
  const std::string_view text = program.text;
  if (const auto section = tp_section(part(text, line.span))) return begin_section(r, *section);
  if (r.section != TpSection::statements) return;
  if (!tp_line_number(text, line.span))
    refuse(program.file, line, line.code.begin,
           fmt::format("'{}' is not a line of /MN; a line begins with its number and a colon: '  1:L P[1] "
                       "100mm/sec FINE ;'",
                       shown(r, line)));
  read_statement(r, line);
}

}  // namespace counterflex
