// Steps: MOVJ, MOVL and the three MOVC of a circle.
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "counterflex/geometry/types.hpp"
#include "program/robot/yaskawa/read.hpp"
#include "program/text/lex.hpp"
#include "program/text/operation.hpp"

namespace counterflex {
namespace {

TargetZone corner_of(const JbiMotion& motion) {
  if (!motion.corner_radius) return {};
  return {.words = motion.corner_radius->span,
          .length_mm = motion.corner_radius->value,
          .least_mm = least_jbi_corner_mm};
}

constexpr std::string_view in_a_body = "a loop or a condition may run the step never or several times";
constexpr std::string_view shifted = "SFTON shifts the positions at run time";
constexpr std::string_view unknown_circle =
    "the circle of these MOVC is not known: write three MOVC one after the other, and FPT where a circle "
    "ends "
    "and the next one begins";

/// Why a step with a Cartesian target is not followed; empty if it is.
std::string why_not_followed(const JbiReading& r, const JbiMotion& motion, const JbiTarget& target) {
  if (r.robot.open_bodies > 0) return std::string(in_a_body);
  if (r.is_shifted) return std::string(shifted);
  return motion.why.empty() ? target.why : motion.why;
}

/// The position of a line or an arc in pulses is only known to the control.
void refuse_pulses(const JbiReading& r, const RobotLine& line, const JbiMotion& motion,
                   const JbiTarget& target) {
  if (!target.is_pulse) return;
  const Program& program = r.robot.program;
  refuse(
      program.file, line, motion.target->span.begin,
      fmt::format("{} moves to '{}', whose values in line {} are pulses: their place is not known; post or "
                  "convert the job with rectangular positions (///RECTAN)",
                  motion.head, part(program.text, motion.target->span),
                  jbi_line_number(program.text, r.job->positions.list[*target.position].line_begin)));
}

void mark_followed(JbiReading& r, const JbiMotion& motion, const JbiTarget& target) {
  ++r.followed[*target.position];
  for (const auto& name : {motion.base, motion.station})
    if (name)
      if (const JbiPosition* position = r.job->positions.find(name->family, name->number))
        ++r.followed[static_cast<std::size_t>(position - r.job->positions.list.data())];
}

/// Enters the state of the step: frame, tool, speed.
void enter(JbiReading& r, const JbiMotion& motion, const JbiTarget& target) {
  constexpr double mm_min = 60;  // in 1 mm/s
  enter_robot_frame(r.robot, target.frame);
  if (r.tool != target.tool) enter_robot_tool(r.robot, as_tool(target.tool));
  r.tool = target.tool;
  r.robot.state.feed_mm_min = mm_min * motion.speed_mm_s.value_or(r.speed_mm_s);
}

void read_joint_step(JbiReading& r, const RobotLine& line, const JbiMotion& motion, const JbiTarget& target) {
  std::string why = why_not_followed(r, motion, target);
  if (why.empty() && target.is_pulse) why = "MOVJ moves to pulses of the joints";
  if (!why.empty()) return add_joint_move(r.robot, line, std::move(why));
  enter(r, motion, target);
  mark_followed(r, motion, target);
  add_target_move(r.robot, line, target.numbers,
                  {.motion = Motion::rapid,
                   .stated_turns = StatedTurns::half_turns,
                   .passes = motion.passes,
                   .zone = corner_of(motion)});
}

/// `is_start`: of a circle, whose first MOVC is a line to its start.
void read_line_step(JbiReading& r, const RobotLine& line, const JbiMotion& motion, const JbiTarget& target,
                    bool is_start) {
  enter(r, motion, target);
  mark_followed(r, motion, target);
  Move move = begin_robot_move(r.robot, line, Motion::feed);
  end_at_target(r.robot, target.numbers, {.passes = motion.passes, .zone = corner_of(motion)}, move);
  if (is_start || motion.stays_whole) move.may_split = move.may_jump = false;
  r.robot.program.moves.push_back(std::move(move));
}

/// An axis without a value stays.
bool moves_external_axes(const JbiReading& r, const JbiTarget& target) {
  for (std::size_t i = 0; i < target.numbers.external.size(); ++i)
    if (const auto& value = target.numbers.external[i]; value && value != r.robot.state.external[i])
      return true;
  return false;
}

void read_auxiliary_point(JbiReading& r, const JbiMotion& motion, const JbiTarget& target) {
  r.auxiliary = JbiAuxiliary{.target = target.numbers, .tool = target.tool};
  r.auxiliary->why = why_not_followed(r, motion, target);
  if (!r.auxiliary->why.empty()) return;
  if (!has_one_use(*r.job, r.job->positions.list[*target.position]))
    r.auxiliary->why = "the point between the ends of a MOVC circle is used by other instructions, too";
  const ProgramFrame& frame = r.robot.program.frames[r.robot.state.frame];
  if (frame != target.frame || r.tool != target.tool || moves_external_axes(r, target))
    r.auxiliary->why = "the points of a MOVC circle differ in frame, tool or external axes";
  if (r.auxiliary->why.empty()) mark_followed(r, motion, target);
}

Matrix3 orientation_of(const RobotTarget& target) {
  OrientationNumbers numbers{};
  for (std::size_t i = 0; i < 3; ++i) numbers[i] = target.orientation[i]->value;
  return rotation_of(OrientationForm::fixed_axes, numbers);
}

/// How the control turns the tool along a circle is not documented. A correction turns it by at most 1
/// degree, and the point inside of the circle as its ends.
bool turns_the_tool(Move& move, const RobotTarget& point, const RobotTarget& end) {
  constexpr double room = 1 * deg, same = 0.02 * deg;
  const Matrix3 R_start = rotation_of(OrientationForm::fixed_axes, move.orientation->start);
  const Matrix3 R_end = orientation_of(end), R_point = orientation_of(point);
  const double turn = rotation_between(R_start, R_end).norm();
  return !limit_turn({.largest_turn = room}, move) || rotation_between(R_point, R_end).norm() > turn + same ||
         rotation_between(R_point, R_start).norm() > turn + same;
}

/// A circle is not divided: the points between its ends would belong to another circle.
void read_circle_end(JbiReading& r, const RobotLine& line, const JbiMotion& motion, const JbiTarget& target) {
  const auto point = std::exchange(r.auxiliary, std::nullopt);
  const auto not_followed = [&](std::string why) { add_unfollowed_move(r.robot, line, std::move(why)); };
  if (!point) return not_followed(std::string(unknown_circle));
  if (!point->why.empty()) return not_followed(point->why);
  enter(r, motion, target);
  Move move = begin_robot_move(r.robot, line, Motion::feed);
  if (!all_known(move.known_start)) return not_followed("the start of the MOVC circle is not known");
  end_at_target(r.robot, target.numbers, {.passes = motion.passes, .zone = corner_of(motion)}, move);
  if (!go_through(point->target, move))
    return not_followed("the three points of the MOVC circle lie on a line");
  if (turns_the_tool(move, point->target, target.numbers))
    return not_followed("MOVC turns the tool along its circle");
  mark_followed(r, motion, target);
  move.may_split = move.may_jump = false;
  r.robot.program.moves.push_back(std::move(move));
}

void read_circle_step(JbiReading& r, const RobotLine& line, const JbiMotion& motion,
                      const JbiTarget& target) {
  const JbiCircleStep step = circle_step(*r.job, line.span.begin);
  if (step == JbiCircleStep::unknown) return add_unfollowed_move(r.robot, line, std::string(unknown_circle));
  if (step == JbiCircleStep::auxiliary) return read_auxiliary_point(r, motion, target);
  std::string why = why_not_followed(r, motion, target);
  if (!why.empty()) return add_unfollowed_move(r.robot, line, std::move(why));
  if (step == JbiCircleStep::end) return read_circle_end(r, line, motion, target);
  read_line_step(r, line, motion, target, true);
}

/// A step that has no position of the robot.
void read_step_without_target(JbiReading& r, const RobotLine& line, const JbiMotion& motion) {
  if (motion.base || motion.station)
    return add_joint_move(r.robot, line, "the step moves only the base or a station");
  if (!motion.why.empty() && motion.head == "MOVJ") return add_joint_move(r.robot, line, motion.why);
  if (!motion.why.empty()) return add_unfollowed_move(r.robot, line, motion.why);
  refuse(r.robot.program.file, line, line.code.begin,
         fmt::format("{0} has no position; write {0} C00001", motion.head));
}

}  // namespace

void read_jbi_move(JbiReading& r, const RobotLine& line) {
  const std::string_view text = r.robot.program.text;
  const Span head = jbi_words(text, line.code).front();
  const JbiMotion motion = jbi_motion(text, line.code);
  if (motion.head == "MOVS")
    refuse(r.robot.program.file, line, head.begin,
           "MOVS is a spline motion, which is not supported; post the job with MOVL, MOVC and MOVJ");
  if (motion.head == "IMOV")
    return add_unfollowed_move(r.robot, line, "IMOV moves relative to the place of the robot at run time");
  if (motion.head != "MOVJ" && motion.head != "MOVL" && motion.head != "MOVC")
    return add_unfollowed_move(
        r.robot, line, fmt::format("{} moves a second group or together with a station", motion.head));
  if (!motion.target && motion.computed_target.empty()) return read_step_without_target(r, line, motion);
  const JbiTarget target = jbi_target(r, line, motion);
  if (motion.head == "MOVJ") return read_joint_step(r, line, motion, target);
  refuse_pulses(r, line, motion, target);
  if (motion.head == "MOVC") return read_circle_step(r, line, motion, target);
  std::string why = why_not_followed(r, motion, target);
  if (!why.empty()) return add_unfollowed_move(r.robot, line, std::move(why));
  read_line_step(r, line, motion, target, false);
}

}  // namespace counterflex
