#include "program/robot/kuka/read.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "program/program_files.hpp"
#include "program/robot/kuka/names.hpp"
#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

using Words = std::span<const std::string_view>;

bool is_one_of(std::string_view word, Words words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

constexpr auto motions =
    std::to_array<std::string_view>({"LIN", "PTP", "CIRC", "LIN_REL", "PTP_REL", "CIRC_REL"});
constexpr auto splines = std::to_array<std::string_view>(
    {"SPLINE", "PTP_SPLINE", "SLIN", "SCIRC", "SPTP", "SLIN_REL", "SCIRC_REL", "SPTP_REL", "SPL"});
constexpr auto body_begins =
    std::to_array<std::string_view>({"IF", "FOR", "WHILE", "LOOP", "REPEAT", "SWITCH"});
constexpr auto body_ends =
    std::to_array<std::string_view>({"ENDIF", "ENDFOR", "ENDWHILE", "ENDLOOP", "UNTIL", "ENDSWITCH"});
/// Declarations and statements that do not move the robot.
constexpr auto motionless = std::to_array<std::string_view>(
    {"ELSE",   "ELSEIF", "CASE",     "DEFAULT", "WAIT",   "HALT",   "INTERRUPT", "TRIGGER",
     "RETURN", "EXIT",   "CONTINUE", "BRAKE",   "RESUME", "EXT",    "EXTFCT",    "IMPORT",
     "SIGNAL", "STRUC",  "ENUM",     "ANIN",    "ANOUT",  "GLOBAL", "CONST"});

constexpr auto coordinates = std::to_array<std::string_view>(
    {"X", "Y", "Z", "A", "B", "C", "A1", "A2", "A3", "A4", "A5", "A6", "E1", "E2", "E3", "E4", "E5", "E6"});

/// "P[3].X" without its last member; empty if that is not a coordinate.
std::string_view target_of_coordinate(std::string_view variable) {
  const std::size_t point = variable.rfind('.');
  if (point == std::string_view::npos) return {};
  const std::string_view member = variable.substr(point + 1);
  return is_one_of(member, coordinates) ? variable.substr(0, point) : std::string_view();
}

/// A variable of the program: a target or a frame with plain numbers, or a value computed at run time.
void assign_variable(KrlReading& r, const RobotLine& line, const std::string& variable, Span value) {
  if (const std::string_view target = target_of_coordinate(variable); !target.empty()) {
    r.named.insert_or_assign(std::string(target), KrlNamed{{}, line.line});
    return;
  }
  const auto aggregate = aggregate_at(r.robot.program.text, value.begin, value.end);
  const bool is_target = aggregate && aggregate->span.end == value.end && krl_target(*aggregate);
  const bool known =
      r.named.contains(variable) || variable.starts_with("BASE_DATA[") || variable.starts_with("TOOL_DATA[");
  if (is_target && !in_body(r))
    r.named.insert_or_assign(variable, KrlNamed{aggregate->span, {}});
  else if (is_target || known)
    r.named.insert_or_assign(variable, KrlNamed{{}, line.line});
}

void assign_speed(KrlReading& r, Span value) {
  const auto speed = number_at(r.robot.program.text, value.begin);
  set_krl_speed(r, speed && speed->span.end == value.end ? speed->value : 0);
}

/// $VEL = {CP 2,ORI1 200,ORI2 200}
void assign_speeds(KrlReading& r, Span value) {
  const auto aggregate = aggregate_at(r.robot.program.text, value.begin, value.end);
  const KrlComponent* speed = aggregate ? find_component(*aggregate, "CP") : nullptr;
  if (speed != nullptr || !aggregate) set_krl_speed(r, speed && speed->number ? speed->number->value : 0);
}

/// $APO.CDIS = 5, $APO = {CDIS 5,CORI 2}
void assign_zone(KrlReading& r, Span value) {
  const std::string_view text = r.robot.program.text;
  const auto aggregate = aggregate_at(text, value.begin, value.end);
  const KrlComponent* distance = aggregate ? find_component(*aggregate, "CDIS") : nullptr;
  if (aggregate && distance == nullptr) return;
  const auto number = distance ? distance->number : number_at(text, value.begin);
  const bool is_plain = number && number->span.end == (distance ? distance->value.end : value.end);
  r.zone_mm = is_plain && !in_body(r) ? number->value : 0;
}

void read_assignment(KrlReading& r, const RobotLine& line, const KrlAssignment& assignment) {
  const std::string_view text = r.robot.program.text;
  const std::string variable = krl_word(part(text, assignment.variable));
  const std::string value = krl_word(part(text, assignment.value));
  if (variable == "$BASE") return assign_krl_base(r, line, assignment.value);
  if (variable == "$TOOL") return assign_krl_tool(r, line, assignment.value);
  if (variable == "$VEL.CP") return assign_speed(r, assignment.value);
  if (variable == "$APO.CDIS" || variable == "$APO") return assign_zone(r, assignment.value);
  if (variable == "$VEL") return assign_speeds(r, assignment.value);
  if (variable == "$CIRC_TYPE") {
    r.why_no_circles = value == "#BASE" && !in_body(r) ? "" : "$CIRC_TYPE=#PATH turns the tool with the path";
    return;
  }
  if (variable == "$ORI_TYPE") return set_krl_orientation_type(r, value);
  if (variable == "FDAT_ACT") return assign_krl_frame_data(r, assignment.value);
  if (variable == "LDAT_ACT") {
    r.line_data = in_body(r) ? variable : part(text, assignment.value);
    return;
  }
  if (variable.ends_with(".IPO_FRAME") && value == "#TCP")
    refuse_krl_fixed_tool(r, line, assignment.variable.begin, variable);
  constexpr std::string_view of_frame_data = "FDAT_ACT.";
  if (variable.starts_with(of_frame_data))
    return assign_krl_frame_member(r, variable.substr(of_frame_data.size()), value);
  if (variable == "$IPO_MODE" && value == "#TCP")
    refuse_krl_fixed_tool(r, line, assignment.variable.begin, variable);
  if (variable.starts_with("$BASE.") || variable.starts_with("$TOOL."))
    refuse(r.robot.program.file, line, assignment.variable.begin,
           fmt::format("'{}' changes one number of a frame, which is not supported; assign all numbers: "
                       "{} = {{X 1, Y 2, Z 3, A 0, B 0, C 0}}",
                       variable, variable.substr(0, 5)));
  assign_variable(r, line, variable, assignment.value);
}

/// The end of the first routine of the file. Its data lists may follow.
void end_routine(KrlReading& r) {
  r.routine_ended = true;
  r.robot.ended = !r.data_lists;
}

void begin_or_end(KrlReading& r) {
  if (r.begun) return end_routine(r);
  r.begun = true;
  if (r.data_lists) read_names_of_lists(r);
}

/// A routine of the file may have set how later motions run. Its values are not followed.
void forget_modes(KrlReading& r, const KrlRoutine& routine, std::string_view name) {
  if (routine.sets_speed) r.robot.state.feed_mm_min = 0;
  if (routine.sets_turns)
    r.why_not_followed = fmt::format("'{}' may set $ORI_TYPE; set it behind the call", name);
  if (routine.sets_circle)
    r.why_no_circles = fmt::format("'{}' may set $CIRC_TYPE; set it behind the call", name);
}

/// A call may run any statement of a routine of another file.
void read_call(KrlReading& r, const RobotLine& line, std::string_view name) {
  r.zone_mm = 0;
  const KrlRoutine* const routine = r.facts.find(krl_word(name));
  if (routine == nullptr && (is_motionless_call(krl_word(name)) || is_stated_harmless(r.robot, line, name)))
    return;
  r.has_called = true;
  if (routine != nullptr && routine->selects_tool) r.lost_tool = line.line;
  if (routine != nullptr && routine->selects_frame) forget_krl_base(r, line);
  if (routine != nullptr) forget_modes(r, *routine, name);
  if (routine != nullptr && !routine->moves) return;
  forget_position(r.robot);
  r.robot.state.external = {};
  r.robot.state.moved_by_machine = true;
  const std::string why = fmt::format("the call of '{}' may move the robot", name);
  if (routine == nullptr || routine->calls_unread) return note_unread_call(r.robot, line, why);
  if (!routine->cuts) return note_uncorrected(r.robot, line, why);
  note_cutting_call(r.robot, line, fmt::format("'{}' is not followed: its motions are not corrected", name));
}

/// The routines that an expression, TRIGGER or INTERRUPT behind the first word of the line calls, and what
/// functions of the control read into $BASE and $TOOL.
void read_inner_calls(KrlReading& r, const RobotLine& line) {
  for (const KrlCall& call : krl_calls(r.robot.program.text, line)) {
    if (reads_into(call, "$BASE")) forget_krl_base(r, line);
    if (reads_into(call, "$TOOL")) r.lost_tool = line.line;
    const KrlRoutine* const routine = r.facts.find(call.word);
    const bool acts =
        routine == nullptr ? !is_motionless_call(call.word) : routine->acts || routine->sets_speed;
    if (acts && call.name.begin != line.code.begin) read_call(r, line, part(r.robot.program.text, call.name));
  }
}

void read_other(KrlReading& r, const RobotLine& line, Span head) {
  const std::string_view text = r.robot.program.text;
  if (const auto assignment = assignment_at(text, line.code.begin, line.code.end))
    return read_assignment(r, line, *assignment);
  const std::size_t next = behind_blanks(text, head.end, line.code.end);
  const char c = next < line.code.end ? text[next] : '\0';
  if (head.begin == head.end)
    refuse(r.robot.program.file, line, line.code.begin, "the statement is not KRL: it begins with no name");
  if (c == '(') return read_call(r, line, part(text, head));
  if (c == ':' && next + 1 == line.code.end) return;  // a label
  add_unfollowed_move(r.robot, line, fmt::format("'{}' is not supported", part(text, head)));
}

}  // namespace

void set_krl_orientation_type(KrlReading& r, std::string_view type) {
  r.why_not_followed =
      type == "#VAR" && !in_body(r) ? "" : fmt::format("the control turns the tool by $ORI_TYPE={}", type);
}

void set_krl_speed(KrlReading& r, double metres_per_second) {
  constexpr double mm_min = 60'000;  // in 1 m/s
  r.robot.state.feed_mm_min = in_body(r) ? 0 : metres_per_second * mm_min;
}

void read_krl_statement(KrlReading& r, const RobotLine& line) {
  const std::string_view text = r.robot.program.text;
  const std::string& file = r.robot.program.file;
  if (text[line.code.begin] == '&') {  // attributes of the file
    const bool back = part(text, line.code).starts_with(back_mark);
    if (!back && !part(text, line.code).starts_with(file_mark)) return;
    --r.robot.program.block_count;  // the line is in no file
    r.in_data_list = !back;
    r.behind_loop = 0;
    r.robot.program.counts.push_back({line.code.begin + file_mark.size(), line.code.end});
    return;
  }
  if (r.in_data_list) return read_data_line(r, line);
  if (r.routine_ended || line.code.begin < r.behind_loop) return;
  const Span name = name_at(text, line.code.begin, line.code.end);
  const std::string head = krl_word(part(text, name));
  read_inner_calls(r, line);
  if (is_one_of(head, motions)) {
    read_krl_motion(r, line, head, name.end);
    r.has_trigger = false;
    return;
  }
  if (is_one_of(head, splines))
    refuse(file, line, name.begin,
           fmt::format("{} is a spline motion, which is not supported; post the job with LIN, CIRC and PTP",
                       head));
  if (head == "DEFDAT")
    refuse(file, line, name.begin,
           "this is a data list, which has no moves; give the .src file of the program");
  if (head == "GOTO")
    refuse(file, line, name.begin,
           "GOTO is not supported; write the statements in the order in which they run");
  if (begins_routine(text, line)) return begin_or_end(r);
  if (head == "END" || head == "ENDFCT" || head == "ENDDEF") return end_routine(r);
  if (head == "FOR" && read_data_loop(r, line)) return;
  if (head == "BAS") {
    r.zone_mm = 0;  // it may set $APO
    return read_krl_bas(r, line, name.end);
  }
  if (is_one_of(head, body_begins)) ++r.robot.open_bodies;
  if (is_one_of(head, body_ends)) r.robot.open_bodies = std::max(r.robot.open_bodies - 1, 0);
  if (is_one_of(head, body_begins) || is_one_of(head, body_ends)) return;
  if (begins_declaration(head)) {
    const auto assignment = assignment_in(text, line.code);
    return assignment ? read_assignment(r, line, *assignment) : void();
  }
  if (head == "TRIGGER") r.has_trigger = true;
  if (is_one_of(head, motionless)) return;
  read_other(r, line, name);
}

}  // namespace counterflex
