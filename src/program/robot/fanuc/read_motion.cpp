// Motion statements: J, L and C.
#include <fmt/format.h>

#include "program/robot/fanuc/read.hpp"
#include "program/text/lex.hpp"

namespace counterflex {
namespace {

constexpr std::string_view in_a_body = "a loop or a condition may run the statement never or several times";

/// Refuses motions whose targets are not the positions of the program.
void check_statement(const TpReading& r, const RobotLine& line, const TpMotion& motion) {
  const Program& program = r.robot.program;
  const auto wrong = [&](std::size_t at, const std::string& message) {
    refuse(program.file, line, at, message);
  };
  const std::size_t begin = line.code.begin;
  if (!ends_with_semicolon(program.text, line.span)) wrong(begin, "the motion has no ';' at its end");
  if (motion.type == 'A' || motion.type == 'S')
    wrong(begin,
          fmt::format("the motion type {} is not supported; post the job with J, L and C", motion.type));
  if (!empty(motion.refused))
    wrong(motion.refused.begin,
          fmt::format("'{}' moves the tool to another place than the programmed target, which is not "
                      "supported; post the job without it",
                      part(program.text, motion.refused)));
  if (motion.type == 'C' && motion.operands.size() < 2)
    wrong(begin, "C has no end point; write C P[1] and in the next line : P[2] 100mm/sec FINE ;");
  for (const TpOperand& operand : motion.operands) {
    const std::string_view name = part(program.text, operand.span);
    if (operand.array == "PR" && motion.type != 'J')
      wrong(operand.span.begin,
            fmt::format("the target {} is a position register, whose value is not in the program; use a "
                        "position of /POS, P[1]",
                        name));
    if (operand.array != "P") continue;
    if (!operand.number)
      wrong(operand.span.begin, fmt::format("the target {} is selected at run time; write its number", name));
    if (!r.file.positions.contains(*operand.number))
      wrong(operand.span.begin, fmt::format("the target {} is not in /POS; add it there", name));
  }
}

/// The control stops at a target whose frame or tool is not the selected one.
void check_selection(const TpReading& r, const RobotLine& line, const TpOperand& operand,
                     const TpPoint& point) {
  const Program& program = r.robot.program;
  const auto compare = [&](std::optional<long> own, std::optional<long> selected, std::string_view name,
                           std::string_view variable) {
    if (!own || !selected || *own == *selected) return;
    refuse(program.file, line, operand.span.begin,
           fmt::format("the target {} has {} : {}, but {}={} is selected: the control stops here; select "
                       "{}={} before the motion",
                       part(program.text, operand.span), name, *own, variable, *selected, variable, *own));
  };
  compare(point.frame, r.frame, "UF", "UFRAME_NUM");
  compare(point.tool, r.tool, "UT", "UTOOL_NUM");
}

std::vector<TpPoint> points_of(const TpReading& r, const RobotLine& line, const TpMotion& motion) {
  const Program& program = r.robot.program;
  std::vector<TpPoint> points;
  for (const TpOperand& operand : motion.operands) {
    points.push_back(tp_point(program.file, program.text, r.file.positions.find(*operand.number)->second));
    if (!points.back().joint) check_selection(r, line, operand, points.back());
  }
  return points;
}

/// A machine file has one chain: other groups must stay.
void watch_other_groups(TpReading& r, const RobotLine& line, const TpPoint& point) {
  std::optional<Remark>& moves = r.robot.program.external_axes_move;
  if (!r.other_groups) r.other_groups = point.other_groups;
  if (*r.other_groups == point.other_groups || moves) return;
  moves =
      Remark{line.line,
             "the second motion group moves from target to target: the machine file has no such axes; keep "
             "them in one place in a program, and put that place into the machine file"};
}

/// Enters the frame and the tool of the target, and the speed.
void enter(TpReading& r, const TpMotion& motion, const TpPoint& point) {
  const std::optional<long> tool = point.tool ? point.tool : r.tool;
  enter_robot_frame(r.robot, tp_frame(r, point.frame));
  if (point.frame) r.selects_no_frame = false;  // the control stops here unless this frame is selected
  if (r.last_tool != tool) enter_robot_tool(r.robot, as_tool(tool.value_or(0)));
  r.last_tool = tool;
  r.robot.state.feed_mm_min = motion.feed_mm_min;
}

/// A copy of the statement has the configuration of the target: a linear motion cannot change it.
void keep_whole(TpReading& r, const TpMotion& motion, const TpPoint& point, Move& move) {
  // Behind a joint target the configuration cannot change: the control would refuse the line.
  const bool changes = r.configuration != point.configuration && !move.starts_uncorrected;
  if (motion.acts_once || changes) move.may_split = move.may_jump = false;
  r.configuration = point.configuration;
}

void note_followed(TpReading& r, const TpMotion& motion) {
  for (const TpOperand& operand : motion.operands) ++r.file.positions.find(*operand.number)->second.followed;
}

void add_line(TpReading& r, const RobotLine& line, const TpMotion& motion, const TpPoint& point) {
  const Motion kind = motion.type == 'J' ? Motion::rapid : Motion::feed;
  Move move = begin_robot_move(r.robot, line, kind);
  const StatedTurns turns = motion.type == 'J' ? StatedTurns::half_turns : StatedTurns::none;
  end_at_target(r.robot, point.target, {.motion = kind, .stated_turns = turns, .passes = motion.passes},
                move);
  keep_whole(r, motion, point, move);
  r.robot.program.moves.push_back(std::move(move));
  note_followed(r, motion);
}

Matrix3 rotation_of_target(const RobotTarget& target) {
  OrientationNumbers numbers{};
  for (std::size_t i = 0; i < 3; ++i) numbers[i] = target.orientation[i]->value;
  return rotation_of(OrientationForm::fixed_axes, numbers);
}

/// Largest difference (rad) between the orientation of an auxiliary point and that of the tool there.
constexpr double room_of_auxiliary_point = 0.5 * deg;

/// A copy of C keeps the orientation of the auxiliary point.
bool keeps_orientation(const Move& move) {
  const Turn turn = turn_of(*move.orientation);
  return rotation_between(turn.end, turn.start).norm() <= room_of_auxiliary_point;
}

void add_circle(TpReading& r, const RobotLine& line, const TpMotion& motion,
                const std::vector<TpPoint>& points) {
  const auto not_followed = [&](std::string why) { add_unfollowed_move(r.robot, line, std::move(why)); };
  if (points[0].frame != points[1].frame || points[0].tool != points[1].tool)
    return not_followed("the points of C have different frames or tools");
  Move move = begin_robot_move(r.robot, line, Motion::feed);
  const bool moved_by_machine = !move.moved_only_by_program[0];
  const auto circle_not_followed = [&](std::string why) {
    r.robot.state.moved_by_machine = moved_by_machine;
    not_followed(std::move(why));
  };
  if (!all_known(move.known_start)) return circle_not_followed("the start of C is not known");
  end_at_target(r.robot, points[1].target, {.passes = motion.passes}, move);
  if (!go_through(points[0].target, move))
    return circle_not_followed("the points of C and its start lie on a line");
  // With the orientation of one turn from start to end it does not matter whether the control uses that of
  // the point.
  if (!limit_turn({.R_point = rotation_of_target(points[0].target), .point_room = room_of_auxiliary_point},
                  move))
    return circle_not_followed("the orientation at the auxiliary point of C is not on the turn to its end");
  keep_whole(r, motion, points[1], move);
  if (!keeps_orientation(move)) move.may_split = move.may_jump = false;
  r.robot.program.moves.push_back(std::move(move));
  note_followed(r, motion);
}

/// The place of a target in joint angles at which the robot stops; empty for other targets, and where the
/// statement may not run.
std::optional<JointPlace> joints_of(const TpReading& r, const TpMotion& motion, const TpPoint& point) {
  if (!point.joint || motion.passes || r.robot.open_bodies > 0) return std::nullopt;
  JointPlace place{.external = point.target.external};
  for (std::size_t i = 0; i < place.joints.size(); ++i) {
    if (!point.joints[i]) return std::nullopt;
    place.joints[i] = *point.joints[i] * deg;
  }
  return place;
}

/// Why a motion with these targets is not followed; empty if it is.
std::string why_not_followed(const TpReading& r, const TpMotion& motion, const std::vector<TpPoint>& points) {
  const std::string_view text = r.robot.program.text;
  if (r.robot.open_bodies > 0) return std::string(in_a_body);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].joint)
      return fmt::format("the target {} is in joint angles", part(text, motion.operands[i].span));
  for (const TpPoint& point : points)
    if (std::string why = why_unknown_frame(r, point.frame); !why.empty()) return why;
  if (!empty(motion.unknown))
    return fmt::format("the word '{}' is not supported", part(text, motion.unknown));
  if (motion.wrist_joint && motion.type != 'J') return "Wjnt does not control the orientation of the tool";
  return {};
}

}  // namespace

void read_tp_motion(TpReading& r, const RobotLine& line, const TpMotion& motion) {
  check_statement(r, line, motion);
  if (motion.operands[0].array == "PR")  // only of J
    return add_joint_move(r.robot, line, "J moves to a position register, whose value is not in the program");
  const std::vector<TpPoint> points = points_of(r, line, motion);
  for (const TpPoint& point : points) watch_other_groups(r, line, point);
  if (std::string why = why_not_followed(r, motion, points); !why.empty())
    return motion.type == 'J'
               ? add_joint_move(r.robot, line, std::move(why), joints_of(r, motion, points.front()))
               : add_unfollowed_move(r.robot, line, std::move(why));
  enter(r, motion, points.back());
  motion.type == 'C' ? add_circle(r, line, motion, points) : add_line(r, line, motion, points.front());
}

}  // namespace counterflex
