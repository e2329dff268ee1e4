#include "program/robot/rapid/read.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "program/gcode/remarks.hpp"
#include "program/robot/rapid/data.hpp"
#include "program/robot/rapid/motion.hpp"
#include "program/text/lex.hpp"

namespace counterflex {
namespace {

/// Instructions that displace the targets behind them at run time.
constexpr auto displacements =
    std::to_array<std::string_view>({"PDISPON", "PDISPSET", "EOFFSON", "EOFFSSET"});

/// At the begin and the end of a routine, and at a label, the robot may be anywhere.
void forget(RapidReading& r) {
  forget_position(r.robot);
  r.robot.state.external.fill(std::nullopt);
  r.robot.state.moved_by_machine = true;
}

void begin_routine(RapidReading& r, const RapidStatement& statement) {
  forget(r);
  r.in_function = statement.head == "FUNC";
  r.any_configuration = r.any_joint_configuration = false;  // another routine may have changed it
  r.robot.open_bodies = statement.head == "TRAP" ? 1 : 0;
  // Another routine may have selected the mode.
  r.circle_path = r.module.calls("CIRPATHMODE") ? "UNKNOWN" : "";
}

/// Text of the statement behind its name, in upper case without blanks.
std::string arguments_of(const RapidReading& r, const RapidStatement& statement) {
  return rapid_word(part(r.robot.program.text, {statement.rest, statement.span.end}));
}

/// States of the control that apply to the motions behind them.
void read_state(RapidReading& r, const RobotLine& line, const RapidStatement& statement) {
  const std::string arguments = arguments_of(r, statement);
  const bool certain = r.robot.open_bodies == 0;
  if (statement.head == "VELSET") r.scaled_speed = true;
  if (statement.head == "CIRPATHMODE") r.circle_path = certain ? arguments : "UNKNOWN";
  if (statement.head == "CONFL") r.any_configuration = certain && arguments == "\\OFF";
  if (statement.head == "CONFJ") r.any_joint_configuration = certain && arguments == "\\OFF";
  if (statement.head != "SINGAREA") return;
  if (arguments == "\\LOCKAXIS4" || certain) r.locks_axis = arguments == "\\LOCKAXIS4";
  if (arguments == "\\WRIST")
    add_remark(r.robot.program, line.line,
               "SingArea\\Wrist lets the control turn the tool differently near a singularity of the wrist");
}

/// The target of MoveAbsJ at which the robot stops; empty if it is not known, and where the statement may not
/// run.
std::optional<JointPlace> joints_of(const RapidReading& r, const RapidStatement& statement) {
  const std::string_view text = r.robot.program.text;
  const RapidMotion motion = rapid_motion(text, statement);
  if (!motion.complete || r.robot.open_bodies > 0) return std::nullopt;
  if (rapid_word(part(text, motion.zone)) != "FINE") return std::nullopt;
  const RapidPlace place{text, r.module, statement.span.begin};
  return rapid_joints(place, motion.targets.front());
}

/// A routine may run any statement. `name`: as the text spells it.
void run_routine(RapidReading& r, const RobotLine& line, std::string_view name) {
  const std::string word = rapid_word(name);
  if (r.module.has_still_routine(word)) return;
  const bool is_read = r.module.has_routine(word);
  if (!is_read && is_stated_harmless(r.robot, line, name)) return;
  forget(r);
  r.any_configuration = r.any_joint_configuration = false;
  const std::string why = fmt::format("the call of '{}' may move the robot", name);
  if (!is_read) return note_unread_call(r.robot, line, why);
  if (r.module.calls("CIRPATHMODE")) r.circle_path = "UNKNOWN";
  note_uncorrected(r.robot, line, why);
}

/// The functions that the expressions of a statement call.
void read_functions(RapidReading& r, const RobotLine& line, const RapidStatement& statement) {
  const std::string_view text = r.robot.program.text;
  for (const Span name : rapid_functions(text, statement)) {
    const std::string word = rapid_word(part(text, name));
    if (r.module.has_routine(word) || !is_motionless_function(word)) run_routine(r, line, part(text, name));
  }
}

void read_call(RapidReading& r, const RobotLine& line, const RapidStatement& statement) {
  const std::string& file = r.robot.program.file;
  const std::string_view text = r.robot.program.text;
  const std::string_view head = statement.head;
  const std::string_view name =
      part(text, rapid_token_at(text, statement.span.begin, statement.span.end).span);
  const bool moves = head == "MOVEL" || head == "MOVEC" || head == "MOVEJ";
  if (r.in_function && (moves || is_linear_instruction(head) || is_joint_instruction(head)))
    refuse(file, line, statement.span.begin, "a function that moves the robot is not supported; use a PROC");
  if (moves) return read_rapid_motion(r, line, statement);
  if (is_among(head, displacements))
    refuse(
        file, line, statement.span.begin,
        fmt::format("{} displaces the targets at run time, which is not supported; post the job without it",
                    name));
  if (head == "MOVEABSJ")
    return add_joint_move(r.robot, line, "MoveAbsJ moves to joint positions", joints_of(r, statement));
  if (is_joint_instruction(head))
    return add_joint_move(r.robot, line, fmt::format("'{}' is not supported", name));
  if (is_linear_instruction(head))
    return add_unfollowed_move(r.robot, line, fmt::format("'{}' is not supported", name));
  if (is_motionless_instruction(head) && !r.module.has_routine(head)) return read_state(r, line, statement);
  run_routine(r, line, name);
}

/// A motion is corrected in its line, and inserted statements precede the line.
void check_line_of_motion(const RapidReading& r, const RobotLine& line, const RapidStatement& statement) {
  const std::string_view text = r.robot.program.text;
  if (statement.kind != RapidKind::call || !statement.head.starts_with("MOVE") || r.robot.open_bodies > 0)
    return;
  if (statement.behind > line.code.end || !statement.ended)
    refuse(r.robot.program.file, line, statement.span.begin,
           "the motion does not end in its line; write it in one line with a ';' at its end");
  const bool alone = statement.span.begin == line.code.begin &&
                     rapid_token_at(text, statement.behind, line.code.end).kind == RapidTokenKind::none;
  if (!alone)
    refuse(r.robot.program.file, line, statement.span.begin,
           "the line has a motion and another statement; write each statement in its own line");
}

void read_statement(RapidReading& r, const RobotLine& line, const RapidStatement& statement) {
  RobotReading& robot = r.robot;
  check_line_of_motion(r, line, statement);
  read_functions(r, line, statement);
  switch (statement.kind) {
    case RapidKind::none:
    case RapidKind::module_begin:
    case RapidKind::branch:
    case RapidKind::assignment:
      return;
    case RapidKind::module_end:
      robot.ended = true;
      return;
    case RapidKind::routine_begin:
      if (!r.whole) r.module.declare(robot.program.text, statement);
      return begin_routine(r, statement);
    case RapidKind::routine_end:
      robot.open_bodies = 0;
      r.in_function = false;
      return forget(r);
    case RapidKind::handler:
    case RapidKind::body_begin:
      ++robot.open_bodies;
      return;
    case RapidKind::body_end:
      robot.open_bodies = std::max(robot.open_bodies - 1, 0);
      return;
    case RapidKind::label:  // GOTO may lead to it
      return forget(r);
    case RapidKind::declaration:
      if (!r.whole) r.module.declare(robot.program.text, statement);
      return;
    case RapidKind::short_if: {
      const std::string_view text = robot.program.text;
      ++robot.open_bodies;
      const std::size_t at = statement_of_short_if(text, statement);
      read_statement(r, line, rapid_statement_at(text, at, statement.behind));
      --robot.open_bodies;
      return;
    }
    case RapidKind::call:
      return read_call(r, line, statement);
  }
}

}  // namespace

void read_rapid_line(RapidReading& r, const RobotLine& line) {
  const std::string_view text = r.robot.program.text;
  if (r.whole && !r.scanned) r.module.scan(text, r.robot.options.harmless_calls);
  r.scanned = true;
  std::size_t at = r.whole ? std::max(line.code.begin, r.behind) : line.code.begin;
  while (at < line.code.end && !r.robot.ended) {
    const RapidStatement statement = rapid_statement_at(text, at, r.whole ? text.size() : line.code.end);
    if (statement.kind == RapidKind::none) break;
    if (statement.span.begin >= line.code.end) break;
    read_statement(r, line, statement);
    at = r.behind = statement.behind;
  }
}

}  // namespace counterflex
