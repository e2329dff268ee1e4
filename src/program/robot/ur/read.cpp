#include "program/robot/ur/read.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "program/robot/ur/still_functions.hpp"
#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr auto ur_motions = std::to_array<std::string_view>({"movej", "movel", "movep", "movec"});
/// Functions that move the robot in a way that is not followed.
constexpr auto ur_other_motions =
    std::to_array<std::string_view>({"servoj", "servoc", "servol", "speedj", "speedl", "freedrive_mode",
                                     "teach_mode", "screw_driving", "move_until_contact"});
/// Functions after which the tool does not go to the programmed targets.
constexpr auto ur_shifting = std::to_array<std::string_view>(
    {"force_mode", "track_conveyor_linear", "track_conveyor_circular", "path_offset_enable"});
/// Words that begin the next part of a body.
constexpr auto ur_body_parts = std::to_array<std::string_view>({"elif", "else", "case", "default"});
/// Words that begin other statements that do not move the robot.
constexpr auto ur_motionless = std::to_array<std::string_view>(
    {"break", "continue", "enter_critical", "exit_critical", "join", "kill", "pass"});

/// A function may run any statement.
void run_function(UrReading& r, const RobotLine& line, std::string_view name) {
  forget_position(r.robot);
  r.robot.state.moved_by_machine = true;
  r.tool.clear();
  const std::string why = fmt::format("the call of '{}' may move the robot", name);
  if (r.names.functions.contains(name)) return note_uncorrected(r.robot, line, why);
  r.names.last_unknown_call = line.code.begin;
  note_unread_call(r.robot, line, why);
}

// Tools have no numbers: another pose is another tool.
void select_tool(UrReading& r, const UrCall& call) {
  const std::string_view text = r.robot.program.text;
  std::string pose;
  std::optional<UrPose> tcp;
  bool is_constant = false;
  if (!call.arguments.empty()) {
    const Span value = ur_resolved(text, r.names, call.arguments.front().value);
    pose = part(text, value);
    tcp = ur_pose(text, value);
    is_constant = tcp && !in_body(r);
  }
  if (is_constant && r.tool == pose) return;
  r.tool = is_constant ? pose : "";
  enter_robot_tool(r.robot, 0, is_constant ? std::optional(ur_pose_mm(*tcp)) : std::nullopt);
}

void refuse_shifting(const UrReading& r, const RobotLine& line, Span name) {
  const std::string_view word = part(r.robot.program.text, name);
  if (is_among(word, ur_shifting))
    refuse(r.robot.program.file, line, name.begin,
           fmt::format("{} shifts the tool away from the programmed targets at run time, which is not "
                       "supported; use a program without it",
                       word));
}

void read_call(UrReading& r, const RobotLine& line, const UrCall& call) {
  const std::string_view name = part(r.robot.program.text, call.name);
  if (r.still_functions.contains(name)) return;
  if (r.names.functions.contains(name)) return run_function(r, line, name);
  if (is_among(name, ur_motions)) return read_ur_motion(r, line, call);
  if (name == "set_tcp") return select_tool(r, call);
  refuse_shifting(r, line, call.name);
  if (is_among(name, ur_other_motions))
    return add_unfollowed_move(r.robot, line, fmt::format("{} is not supported", name));
  if (is_ur_motionless_call(name)) return;
  if (!is_stated_harmless(r.robot, line, name)) run_function(r, line, name);
}

/// The calls in an expression, in arguments or in "run thread()": not the one that begins the statement.
void read_inner_calls(UrReading& r, const RobotLine& line) {
  const std::string_view text = r.robot.program.text;
  for (const UrCallName& call : ur_calls(text, line.code)) {
    if (call.name.begin == line.code.begin) continue;
    const std::string_view name = part(text, call.name);
    if (r.still_functions.contains(call.word)) continue;
    if (r.names.functions.contains(call.word)) {
      run_function(r, line, name);
      continue;
    }
    refuse_shifting(r, line, call.name);
    if (is_among(call.word, ur_motions) || is_among(call.word, ur_other_motions) || call.word == "set_tcp")
      refuse(r.robot.program.file, line, call.name.begin,
             fmt::format("the call of {} is a part of another statement; write each statement into a line of "
                         "its own",
                         name));
    if (is_ur_motionless_call(call.word) || is_stated_harmless(r.robot, line, name)) continue;
    run_function(r, line, name);
  }
}

/// "x = 1 y = 2": the end of the first statement is not known for sure.
void refuse_second_statement(const UrReading& r, const RobotLine& line, const UrAssignment& assignment) {
  const std::string_view text = r.robot.program.text;
  if (const auto second = ur_second_statement(text, assignment.value))
    refuse(r.robot.program.file, line, *second,
           fmt::format("unexpected text behind the value of {}; write each statement into a line of its own",
                       part(text, assignment.variable)));
}

void refuse_empty_argument(const UrReading& r, const RobotLine& line, const UrCall& call) {
  const Program& program = r.robot.program;
  for (std::size_t i = 0; i < call.arguments.size(); ++i)
    if (empty(call.arguments[i].value))
      refuse(program.file, line, call.arguments[i].span.begin,
             fmt::format("argument {} of {} is empty; write its value, or remove its comma", i + 1,
                         part(program.text, call.name)));
}

/// Which of several functions is the program is not known.
void refuse_second_function(const UrReading& r, const RobotLine& end) {
  const Program& program = r.robot.program;
  RobotLine line = end;
  while (next_robot_line(program.text, ur_comment, line)) {
    const Span head = ur_name_at(program.text, line.code.begin, line.code.end);
    if (part(program.text, head) == "def")
      refuse(program.file, line, head.begin,
             "this is a second function, and which one is the program is not known; put functions inside of "
             "the program's 'def', or use a file for each");
  }
}

void end_program(UrReading& r, const RobotLine& line) {
  refuse_second_function(r, line);
  r.robot.ended = true;
}

void close_body(UrReading& r, const RobotLine& line) {
  if (r.robot.open_bodies > 0) {
    --r.robot.open_bodies;
    return;
  }
  if (!r.begun) refuse(r.robot.program.file, line, line.code.begin, "'end' closes nothing");
  end_program(r, line);
}

void require_colon(const UrReading& r, const RobotLine& line, std::string_view head) {
  if (r.robot.program.text[line.code.end - 1] != ':')
    refuse(r.robot.program.file, line, line.code.begin,
           fmt::format("the line of '{}' does not end with ':'; write statements into lines of their own",
                       head));
}

/// Whether `head` begins or divides a body, a function among them.
bool reads_structure(UrReading& r, const RobotLine& line, std::string_view head) {
  const bool opens = ur_opens_body(head);
  if (opens || is_among(head, ur_body_parts)) require_colon(r, line, head);
  if (opens) {
    if (head == "def" && !r.begun && !in_body(r))
      r.begun = true;
    else
      ++r.robot.open_bodies;
  }
  return opens || is_among(head, ur_body_parts);
}

}  // namespace

void read_ur_statement(UrReading& r, const RobotLine& line) {
  const std::string_view text = r.robot.program.text;
  const std::string& file = r.robot.program.file;
  if (text[line.code.begin] == '$') return;  // a line of the program tree
  const Span name = ur_name_at(text, line.code.begin, line.code.end);
  const std::string_view head = part(text, name);
  if (head.empty())
    refuse(file, line, line.code.begin, "the statement is not URScript: it begins with no name");
  if (head == "end") return close_body(r, line);
  if (reads_structure(r, line, head)) return ur_begins_function(head) ? void() : read_inner_calls(r, line);
  if (const auto assignment = ur_assignment(text, line.code)) {
    read_inner_calls(r, line);
    return refuse_second_statement(r, line, *assignment);
  }
  if (head == "return" || head == "halt") {
    read_inner_calls(r, line);
    if (!in_body(r)) end_program(r, line);
    return;
  }
  if (is_among(head, ur_motionless) || head == "global" || head == "local") return read_inner_calls(r, line);
  const std::size_t next = behind_blanks(text, name.end, line.code.end);
  if (next >= line.code.end || text[next] != '(') {
    read_inner_calls(r, line);
    return add_unfollowed_move(r.robot, line, fmt::format("'{}' is not supported", part(text, line.code)));
  }
  const auto call = ur_call_at(text, line.code.begin, line.code.end);
  if (!call)
    refuse(file, line, next,
           fmt::format("the arguments of {} have no closing parenthesis in this line", head));
  if (call->span.end != line.code.end)
    refuse(file, line, call->span.end,
           fmt::format("unexpected text behind the call of {}; write each statement into a line of its own",
                       head));
  refuse_empty_argument(r, line, *call);
  read_inner_calls(r, line);
  read_call(r, line, *call);
}

}  // namespace counterflex
