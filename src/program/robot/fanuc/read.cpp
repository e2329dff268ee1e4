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
constexpr auto motionless = std::to_array<std::string_view>({"DO[",          "DI[",
                                                             "RO[",          "RI[",
                                                             "AO[",          "AI[",
                                                             "GO[",          "GI[",
                                                             "SO[",          "SI[",
                                                             "UO[",          "UI[",
                                                             "WO[",          "WI[",
                                                             "WSO[",         "WSI[",
                                                             "R[",           "SR[",
                                                             "AR[",          "F[",
                                                             "M[",           "VR[",
                                                             "PL[",          "$",
                                                             "TIMER[",       "TIMER_",
                                                             "OVERRIDE=",    "WAIT",
                                                             "MESSAGE[",     "UALM[",
                                                             "PAYLOAD[",     "JMPLBL[",
                                                             "RSR[",         "ABORT",
                                                             "PAUSE",        "ARCSTART",
                                                             "ARCEND",       "WELDSTART",
                                                             "WELDEND",      "COLDETECT",
                                                             "COLGUARD",     "LOCKPREG",
                                                             "UNLOCKPREG",   "SKIPCONDITION",
                                                             "JOINT_MAX_",   "LINEAR_MAX_SPEED",
                                                             "VISIONRUN_",   "VISIONGET_",
                                                             "CLEAR",        "ERROR_PROG=",
                                                             "RESUME_PROG",  "MAINT_PROG=",
                                                             "RETURN_PATH_", "STRLEN",
                                                             "TPSHOW",       "LOCKVREG",
                                                             "UNLOCKVREG",   "TPUSRPRG"});
/// Begins of the statements of `read_tp_assignment`.
constexpr auto assigned =
    std::to_array<std::string_view>({"UFRAME_NUM=", "UTOOL_NUM=", "UFRAME[", "UTOOL[", "PR["});
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

/// "SPINDLE_ON" of "CALLSPINDLE_ON(1,2)", and the name of a macro.
std::string_view called_program(std::string_view action) {
  for (const std::string_view word : {"CALL", "RUN"})
    if (action.starts_with(word)) return action.substr(word.size(), action.find('(') - word.size());
  return action.substr(0, action.find('('));
}

/// Another program may move the robot and set frames, tools and registers.
void read_call(TpReading& r, const RobotLine& line, std::string_view action) {
  if (is_stated_harmless(r.robot, line, called_program(action))) return;
  forget_tp_state(r);
  forget_tp_frames(r, line.line);
  note_unread_call(r.robot, line,
                   fmt::format("'{}' may move the robot, or set its frames and tools", shown(r, line)));
}

/// The action of "IF R[1]=2,PR[1,2]=5": the text behind the last comma that is outside of brackets.
std::string behind_condition(const std::string& statement) {
  std::size_t behind = 0;
  int depth = 0;
  for (std::size_t at = 0; at < statement.size(); ++at) {
    const char c = statement[at];
    if (c == '[' || c == '(') ++depth;
    if (c == ']' || c == ')') --depth;
    if (c == ',' && depth == 0) behind = at + 1;
  }
  return statement.substr(behind);
}

bool is_conditional(std::string_view statement) {
  return (statement.starts_with("IF") && !statement.ends_with("THEN")) || statement.starts_with("SELECT") ||
         statement.starts_with("=") || statement.starts_with("ELSE,");
}

bool is_call(std::string_view action) {
  return !action.empty() && !begins_with_any(action, motionless) && !begins_with_any(action, assigned);
}

/// A jump, a call or an assignment under a condition, or at the end of a motion.
void read_action(TpReading& r, const RobotLine& line, const std::string& action) {
  if (is_call(action)) return read_call(r, line, action);
  ++r.robot.open_bodies;
  read_tp_assignment(r, line, action);
  --r.robot.open_bodies;
}

/// Whether the statement begins or ends a loop or a block of a condition.
bool is_body(std::string_view statement) {
  return statement.starts_with("FOR") || (statement.starts_with("IF") && statement.ends_with("THEN")) ||
         statement == "ENDIF" || statement == "ENDFOR" || statement == "ELSE" || statement == "END";
}

void read_body(TpReading& r, std::string_view statement) {
  int& open = r.robot.open_bodies;
  if (statement == "ENDIF" || statement == "ENDFOR")
    open = std::max(open - 1, 0);
  else if (!statement.starts_with("E"))
    ++open;
}

void read_statement(TpReading& r, const RobotLine& line) {
  const std::string_view text = r.robot.program.text;
  if (shown(r, line).starts_with("//")) return;  // is not executed
  if (const TpMotion motion = tp_motion(text, line.code); motion.type != 0) {
    read_tp_motion(r, line, motion);
    return read_action(r, line, motion.action);
  }
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
  if (is_body(statement)) return read_body(r, statement);
  if (is_conditional(statement)) return read_action(r, line, behind_condition(statement));
  if (!read_tp_assignment(r, line, statement) && is_call(statement)) read_call(r, line, statement);
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

bool tp_calls(std::string_view text, Span code) {
  if (const TpMotion motion = tp_motion(text, code); motion.type != 0) return is_call(motion.action);
  const std::string statement = tp_word(part(text, code));
  if (statement.empty() || statement.starts_with("LBL[") || is_body(statement)) return false;
  return is_call(is_conditional(statement) ? behind_condition(statement) : statement);
}

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
