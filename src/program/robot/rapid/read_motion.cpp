// MoveL, MoveC and MoveJ.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/robot/rapid/motion.hpp"
#include "program/robot/rapid/read.hpp"
#include "program/text/lex.hpp"

namespace counterflex {
namespace {

constexpr std::string_view example = "[[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]";

/// A motion with its arguments read.
struct MoveArguments {
  RapidMotion text;
  std::vector<RapidOperand> targets;
  RapidFrame tool, object;
  RapidZone zone;
};

/// Refuses at byte `at`, which may be in another line of a whole text.
[[noreturn]] void refuse_at(const RapidReading& r, const RobotLine& line, std::size_t at,
                            const std::string& message) {
  const Program& program = r.robot.program;
  if (at >= line.span.begin && at <= line.span.end) refuse(program.file, line, at, message);
  RobotLine other;
  while (next_robot_line(program.text, rapid_comment, other) && other.span.end < at) {
  }
  refuse(program.file, other, at, message);
}

/// Refuses a list that is not a target, and a quaternion that is not of unit length: the control stops at it.
void check_target(const RapidReading& r, const RobotLine& line, const RapidOperand& operand) {
  constexpr double room = 0.01;
  if (operand.malformed)
    refuse_at(r, line, operand.numbers.begin,
              fmt::format("the target is not a robtarget; write position, quaternion, configuration and "
                          "external axes: {}",
                          example));
  if (!operand.why.empty()) return;
  double squares = 0;
  for (const auto& number : operand.target.orientation) squares += number->value * number->value;
  const double length = std::sqrt(squares);
  if (!(std::abs(length - 1) <= room))
    refuse_at(r, line, operand.target.orientation[0]->span.begin,
              fmt::format("the quaternion has length {:.4f}; the length must be 1 within {}; check its four "
                          "numbers",
                          length, room));
}

/// A tool beside the robot, or a work object that the robot holds.
void refuse_fixed_tool(const RapidReading& r, const RobotLine& line, const MoveArguments& motion) {
  const bool held = motion.object.held.value_or(false);
  if (!held && motion.tool.held.value_or(true)) return;
  refuse(r.robot.program.file, line, motion.text.tool.begin,
         fmt::format("'{}' moves the workpiece to a fixed tool (robhold of the {}), which is not supported; "
                     "use a tool that the robot holds",
                     held ? motion.object.name : motion.tool.name, held ? "work object" : "tool"));
}

/// One name for all spellings of a work object that is not declared.
std::string spelling_of(RapidReading& r, const std::string& name) {
  return r.spellings.emplace(rapid_word(name), name).first->second;
}

MoveArguments motion_of(RapidReading& r, const RobotLine& line, const RapidStatement& statement) {
  const std::string_view text = r.robot.program.text;
  const RapidPlace place{text, r.module, statement.span.begin};
  MoveArguments motion{.text = rapid_motion(text, statement)};
  const Span head = rapid_token_at(text, statement.span.begin, statement.span.end).span;
  if (!motion.text.complete)
    refuse(r.robot.program.file, line, statement.span.begin,
           fmt::format("{0} has missing or extra arguments; write {0} {1}, speed, zone, tool;",
                       part(text, head), statement.head == "MOVEC" ? "point, target" : "target"));
  for (const Span target : motion.text.targets) {
    motion.targets.push_back(rapid_operand(place, target));
    check_target(r, line, motion.targets.back());
  }
  const RapidOption* object = motion.text.find("WOBJ");
  motion.tool = rapid_tool(place, motion.text.tool);
  motion.object = rapid_work_object(place, object != nullptr ? object->value : Span{});
  motion.object.name = spelling_of(r, motion.object.name);
  motion.zone = rapid_zone(place, motion.text.zone);
  refuse_fixed_tool(r, line, motion);
  return motion;
}

/// Why the motion is not followed; empty if it is.
std::string why_not_followed(const RapidReading& r, const RapidStatement& statement,
                             const MoveArguments& motion) {
  if (r.robot.open_bodies > 0)
    return "a loop, a condition, a handler or an interrupt may run the statement never or several times";
  for (const RapidOperand& target : motion.targets)
    if (!target.why.empty()) return target.why;
  if (!motion.tool.why.empty()) return motion.tool.why;
  if (!motion.object.why.empty()) return motion.object.why;
  if (motion.text.has("CORR")) return "\\Corr adds corrections at run time";
  if (statement.head == "MOVEJ") return {};
  if (r.locks_axis) return "SingArea\\LockAxis4 changes the orientation of the tool";
  return {};
}

/// \V replaces the speed of the tool centre point, \T gives the time of the motion.
double feed_of(const RapidReading& r, const RapidStatement& statement, const MoveArguments& motion) {
  constexpr double mm_min = 60;  // in 1 mm/s
  const std::string_view text = r.robot.program.text;
  if (r.scaled_speed || motion.text.has("T")) return 0;
  if (const RapidOption* speed = motion.text.find("V")) {
    const auto number = number_at(text, speed->value.begin);
    return number && number->span.end == speed->value.end ? mm_min * number->value : 0;
  }
  return rapid_speed({text, r.module, statement.span.begin}, motion.text.speed);
}

/// A copy of the statement would take the time \T again, stop for \ID, or be one of the few that \Conc
/// allows. A copy has the configuration of the target: where that of the start is another one, the control
/// would stop at the copy, unless ConfL\Off allows any.
void keep_whole(RapidReading& r, const MoveArguments& motion, Move& move) {
  const std::string& configuration = motion.targets.back().configuration;
  // Behind a joint target it cannot change: the control would refuse the line.
  const bool changes = r.configuration != configuration && !r.any_configuration && !move.starts_uncorrected;
  if (changes) move.may_split = move.may_jump = false;
  r.configuration = configuration;
  for (const std::string_view option : {"T", "ID", "CONC", "Z"})
    if (motion.text.has(option)) move.may_split = move.may_jump = false;
}

OrientationNumbers orientation_of(const RobotTarget& target) {
  OrientationNumbers numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = target.orientation[i]->value;
  return numbers;
}

/// Largest difference (rad) between the orientation of a circle point and that of the tool there.
constexpr double room_of_circle_point = 15 * deg;

/// What MoveC must keep so that the control turns the tool about one fixed axis. By default
/// (CirPathMode\PathFrame) it interpolates the orientation relative to the path; that is the same for a turn
/// about the normal of the arc. Corrections at both ends add a little turn about other axes. Of the two
/// directions of the turn the control takes that of the circle point, `point`: ABB, RAPID Instructions,
/// Functions and Data types, 3HAC16581, "MoveC" and "CirPathMode".
ArcTurnLimits turn_limits(const RapidReading& r, const RobotTarget& point) {
  constexpr double same = 1.3e-4;  // rad
  ArcTurnLimits limits{.R_point = rotation_of(OrientationForm::quaternion, orientation_of(point)),
                       .point_room = room_of_circle_point,
                       .largest_turn = 179 * deg,
                       .least_share = 0.1};  // both directions differ clearly there
  if (r.circle_path != "\\OBJECTFRAME") limits.path_room = same;
  return limits;
}

/// Whether the mode of the orientation along circles is one that `turn_limits` describes.
bool is_known_circle_path(const RapidReading& r) {
  return r.circle_path.empty() || r.circle_path == "\\PATHFRAME" || r.circle_path == "\\OBJECTFRAME";
}

/// Enters the state of the motion: work object, tool, speed.
void enter(RapidReading& r, const RapidStatement& statement, const MoveArguments& motion) {
  enter_robot_frame(r.robot, {.work_offset = motion.object.name, .pose_mm = motion.object.pose_mm});
  if (r.tool != motion.tool.name) enter_robot_tool(r.robot, 0, motion.tool.pose_mm);
  r.tool = motion.tool.name;
  r.robot.state.feed_mm_min = feed_of(r, statement, motion);
}

bool passes(const MoveArguments& motion) {
  return motion.zone.passes && !motion.text.has("INPOS");
}

void add_line(RapidReading& r, const RobotLine& line, const MoveArguments& motion, Motion kind) {
  Move move = begin_robot_move(r.robot, line, kind);
  const bool states_turns = kind == Motion::rapid && !r.any_joint_configuration;
  end_at_target(r.robot, motion.targets[0].target,
                {.motion = kind,
                 .stated_turns = states_turns ? StatedTurns::quadrants : StatedTurns::none,
                 .passes = passes(motion),
                 .zone = {.words = motion.text.zone, .length_mm = motion.zone.radius_mm}},
                move);
  keep_whole(r, motion, move);
  r.robot.program.moves.push_back(std::move(move));
}

void add_circle(RapidReading& r, const RobotLine& line, const MoveArguments& motion) {
  Move move = begin_robot_move(r.robot, line, Motion::feed);
  const bool displaced = std::ranges::any_of(
      motion.targets, [](const RapidOperand& target) { return target.form == RapidOperand::Form::derived; });
  const bool moved_by_machine = !move.moved_only_by_program[0];
  const auto not_followed = [&](std::string why) {
    r.robot.state.moved_by_machine = moved_by_machine;
    add_unfollowed_move(r.robot, line, std::move(why));
  };
  if (displaced) return not_followed("a point of MoveC is displaced by Offs or RelTool");
  if (!all_known(move.known_start)) return not_followed("the start of MoveC is not known");
  end_at_target(
      r.robot, motion.targets[1].target,
      {.passes = passes(motion), .zone = {.words = motion.text.zone, .length_mm = motion.zone.radius_mm}},
      move);
  if (!go_through(motion.targets[0].target, move))
    return not_followed("the points of MoveC and its start lie on a line");
  if (!is_known_circle_path(r))
    return not_followed(
        "how MoveC turns the tool is not known: state CirPathMode\\PathFrame or \\ObjectFrame before it in "
        "this routine");
  if (!limit_turn(turn_limits(r, motion.targets[0].target), move))
    return not_followed("MoveC turns the tool relative to the path");
  keep_whole(r, motion, move);
  r.robot.program.moves.push_back(std::move(move));
}

}  // namespace

void read_rapid_motion(RapidReading& r, const RobotLine& line, const RapidStatement& statement) {
  const MoveArguments motion = motion_of(r, line, statement);
  const std::string why = why_not_followed(r, statement, motion);
  const bool joint = statement.head == "MOVEJ";
  if (!why.empty() && joint) return add_joint_move(r.robot, line, why);
  if (!why.empty()) return add_unfollowed_move(r.robot, line, why);
  enter(r, statement, motion);
  if (statement.head == "MOVEC") return add_circle(r, line, motion);
  add_line(r, line, motion, joint ? Motion::rapid : Motion::feed);
}

}  // namespace counterflex
