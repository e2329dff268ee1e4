#include "program/robot/reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "counterflex/geometry/curve.hpp"
#include "program/gcode/frames.hpp"
#include "program/gcode/remarks.hpp"
#include "program/text/arc_radius.hpp"
#include "program/text/force_comment.hpp"
#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

bool orientation_is_known(const RobotReading& r) {
  if (!r.turns) return true;
  const auto count = static_cast<std::ptrdiff_t>(number_count(r.form));
  const auto& known = r.state.known_orientation;
  return std::all_of(known.begin(), known.begin() + count, [](bool is_known) { return is_known; });
}

std::array<bool, 3> known_axes(const RobotReading& r) {
  return orientation_is_known(r) ? r.state.known_position : std::array<bool, 3>{};
}

void place_position(const RobotTarget& target, bool relative, RobotState& state, Move& move) {
  move.relative = relative;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& number = target.position[axis];
    if (!number) continue;
    double& position_mm = state.position_mm[static_cast<Eigen::Index>(axis)];
    position_mm = relative ? position_mm + number->value : number->value;
    state.known_position[axis] = !relative || state.known_position[axis];
    if (state.known_position[axis]) move.words[axis] = number->word();
  }
}

void place_orientation(const RobotTarget& target, RobotReading& r, Move& move) {
  if (!r.turns) return;
  RobotState& state = r.state;
  MoveOrientation orientation{.form = r.form, .start = state.orientation};
  if (r.form != OrientationForm::axis) orientation.spindle_axis = r.options.spindle_axis;
  for (std::size_t i = 0; i < number_count(r.form); ++i) {
    if (!target.orientation[i]) continue;
    state.orientation[i] = target.orientation[i]->value;
    state.known_orientation[i] = true;
    orientation.words[i] = target.orientation[i]->word();
  }
  orientation.end = state.orientation;
  if (!all_known(move.known_start)) orientation.start = orientation.end;
  if (orientation_is_known(r)) move.orientation = orientation;
}

/// Whether the external axes of a target have the values that they have.
bool keeps_external(const RobotTarget& target, const RobotState& state) {
  for (std::size_t i = 0; i < target.external.size(); ++i)
    if (target.external[i] && target.external[i] != state.external[i]) return false;
  return true;
}

/// The start of `move` at joint values has no place in its coordinates.
void forget_start(RobotReading& r, Move& move) {
  forget_position(r);
  move.starts_uncorrected = false;
  move.known_start.fill(false);
}

/// Whether external axes stay, so that a copy of the statement may end anywhere on the path.
bool place_external(const RobotTarget& target, RobotReading& r, int line) {
  RobotState& state = r.state;
  bool stay = true;
  for (std::size_t i = 0; i < target.external.size(); ++i) {
    const std::optional<double> value = target.external[i] ? target.external[i] : state.external[i];
    std::optional<ExternalAxis>& first = r.program.external_axes[i];
    if (!value) {
      if (!first) first = state.external_at_joints[i];
      int& unknown_in = first ? first->unknown_in : state.external_unknown_in[i];
      if (unknown_in == 0) unknown_in = line;
      continue;
    }
    stay = stay && state.external[i] == value;
    state.external[i] = value;
    if (!first) first = ExternalAxis{*value, line, state.external_unknown_in[i]};
    if (first->value == *value || r.program.external_axes_move) continue;
    r.program.external_axes_move =
        Remark{line, fmt::format("external axis E{} moves from {} to {}: a program is corrected only if its "
                                 "external axes stay; divide it where they move",
                                 i + 1, first->value, *value)};
  }
  return stay;
}

/// A line at whose end the robot stops is not split: it would stop at each inserted point, too, and leave a
/// mark. An inserted statement is a copy: external axes that move would be at their end too early.
void allow_changes(const TargetMove& how, bool external_stay, Move& move) {
  const bool line = move.motion == Motion::feed && all_known(move.known_start) && all_known(move.known_end);
  move.exact_stop = move.motion == Motion::feed && !how.passes;
  move.may_split = line && how.passes && external_stay && !how.stays_whole;
  // Behind a joint target the robot may stop once more: the correction begins there.
  const bool may_begin =
      !how.stays_whole && (move.may_split || (line && external_stay && move.starts_uncorrected));
  move.may_jump = may_begin && move.feed_mm_min > 0;
}

void count_zone(const TargetMove& how, int line, Zones& zones) {
  if (!how.passes || !how.rounds) return;
  ++zones.count;
  if (how.zone.length_mm <= zones.largest_mm) return;
  zones.largest_mm = how.zone.length_mm;
  zones.largest_line = line;
}

/// The robot stays, but not its coordinates.
void forget_coordinates(RobotReading& r) {
  r.state.known_position.fill(false);
  r.state.known_orientation.fill(false);
}

/// The place of the tool after a joint target, for a move in `line`.
void place_at_joints(RobotReading& r, int line, Motion motion) {
  RobotState& state = r.state;
  const auto joints = std::exchange(state.joints, std::nullopt);
  if (joints && !r.options.kinematics && motion == Motion::feed)
    add_remark(
        r.program, line,
        "the line begins at a target in joint values: it is corrected from its start if the machine file "
        "has [controller] joint_values = \"as_shown\"");
  if (!joints || !r.options.kinematics) return;
  const auto X = pose_at_joints(r, *joints, r.program.frames[state.frame]);
  if (!X) return;
  state.at_joints = true;
  state.position_mm = X->p;
  state.known_position.fill(true);
  state.known_orientation.fill(r.turns);
  if (!r.turns) return;
  state.orientation = numbers_of(r.form, X->R, {1, 0, 0, 0});
}

}  // namespace

std::optional<Pose> pose_at_joints(const RobotReading& r, const JointPlace& joints,
                                   const ProgramFrame& frame) {
  if (!r.options.kinematics) return std::nullopt;
  JointPlace place = joints;
  place.tcp_mm = r.state.tcp_mm;
  place.other_tool = r.state.tools > 1;
  auto X = r.options.kinematics(place, r.state.tool, frame);
  if (X && r.form != OrientationForm::axis) X->R = X->R * tool_axes(r.options.spindle_axis).transpose();
  return X;
}

Move begin_robot_move(RobotReading& r, const RobotLine& line, Motion motion) {
  RobotState& state = r.state;
  place_at_joints(r, line.line, motion);
  Move move;
  move.line = line.line;
  move.block_index = r.program.block_count - 1;
  move.block = line.span;
  move.motion = motion;
  move.known_start = known_axes(r);
  move.moved_only_by_program.fill(!state.moved_by_machine);
  move.starts_uncorrected = std::exchange(state.at_joints, false);
  move.start_mm = move.end_mm = state.position_mm;
  move.unit = state.unit;
  move.feed_mm_min = state.feed_mm_min;
  move.spindle_rpm = state.spindle_rpm;
  move.frame = state.frame;
  move.tool = state.tool;
  move.operation = r.operation.index_in(r.program, motion, state.tool);
  move.force = state.force;
  state.moved_by_machine = false;
  return move;
}

void end_at_target(RobotReading& r, const RobotTarget& target, const TargetMove& how, Move& move) {
  if (move.starts_uncorrected && (how.relative || !keeps_external(target, r.state))) forget_start(r, move);
  place_position(target, how.relative, r.state, move);
  constexpr double shortest_mm = 0.1;
  if (move.starts_uncorrected && (r.state.position_mm - move.start_mm).norm() < shortest_mm) {
    move.starts_uncorrected = false;
    move.known_start.fill(false);
  }
  place_orientation(target, r, move);
  if (!orientation_is_known(r)) forget_position(r);  // until one target has all of its numbers
  move.end_mm = r.state.position_mm;
  move.known_end = known_axes(r);
  if (move.orientation) move.orientation->stated_turns = how.stated_turns;
  allow_changes(how, place_external(target, r, move.line), move);
  count_zone(how, move.line, r.program.zones);
  const bool in_zone = how.passes && how.zone.length_mm > 0;
  r.began_in_zone = std::exchange(r.in_zone, in_zone);
  if (in_zone && how.zone.words.end > how.zone.words.begin) move.zone = how.zone;
  if (all_known(move.known_end)) return r.last_reason.clear();
  note_uncorrected(
      r, {.line = move.line},
      "the position or the orientation of the tool is not known: program a target with all numbers "
      "first");
}

bool go_through(const RobotTarget& point, Move& move) {
  if (!all_known(move.known_start) || !all_known(move.known_end) || move.relative) return false;
  ArcMove way;
  ArcPoint through;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!point.position[axis]) return false;
    through.p_mm[static_cast<Eigen::Index>(axis)] = point.position[axis]->value;
    way.centre_words[axis] = point.position[axis]->word();
  }
  constexpr double largest_radius_mm = 1e6;  // a larger circle is a line: its centre is known badly
  const auto arc = arc_through(move.start_mm, through.p_mm, move.end_mm);
  if (!arc || !((arc->centre - move.start_mm).norm() < largest_radius_mm)) return false;
  through.normal = arc->normal;
  through.share = sweep_between(move.start_mm, through.p_mm, arc->centre, arc->normal) / arc->sweep;
  Eigen::Index nearest = 0;
  arc->normal.cwiseAbs().maxCoeff(&nearest);
  way.normal = static_cast<int>(nearest);
  way.clockwise = arc->normal[nearest] < 0;
  way.centre_mm = arc->centre;
  way.through = through;
  move.arc = way;
  return true;
}

bool limit_turn(const ArcTurnLimits& limits, Move& move) {
  const Vector3 normal = normal_of(*move.arc);
  move.arc->through->turn_limits = limits;
  return keeps_limits(limits,
                      {.normal = normal,
                       .sweep = sweep_between(move.start_mm, move.end_mm, move.arc->centre_mm, normal),
                       .point_share = move.arc->through->share,
                       .turn = written_turn_of(*move.orientation)});
}

void add_target_move(RobotReading& r, const RobotLine& line, const RobotTarget& target,
                     const TargetMove& how) {
  Move move = begin_robot_move(r, line, how.motion);
  end_at_target(r, target, how, move);
  r.program.moves.push_back(std::move(move));
}

void add_unfollowed_move(RobotReading& r, const RobotLine& line, std::string why) {
  Move move = begin_robot_move(r, line, Motion::feed);
  move.fixed.fill(true);
  move.may_insert_words = false;
  forget_position(r);
  r.state.external = {};
  r.program.moves.push_back(std::move(move));
  note_uncorrected(r, line, std::move(why));
}

void add_joint_move(RobotReading& r, const RobotLine& line, std::string why,
                    const std::optional<JointPlace>& joints) {
  const auto external = std::exchange(r.state.external, {});
  forget_position(r);
  if (joints) {
    r.state.joints = joints;
    r.state.joints_line = line.line;
    for (std::size_t i = 0; i < external.size(); ++i)  // an axis without a value stays
      if (!joints->external[i]) r.state.joints->external[i] = external[i];
    r.state.external = r.state.joints->external;
    for (std::size_t i = 0; i < external.size(); ++i)
      if (const auto& value = joints->external[i])
        r.state.external_at_joints[i] = ExternalAxis{*value, line.line};
  }
  r.state.moved_by_machine = true;
  r.last_reason = why;
  r.program.left_alone.push_back({.line = line.line, .why = std::move(why), .machine_position = true});
}

void note_uncorrected(RobotReading& r, const RobotLine& line, std::string why) {
  if (r.last_reason == why) return;
  r.last_reason = why;
  r.program.left_alone.push_back({.line = line.line, .why = std::move(why)});
}

void note_cutting_call(RobotReading& r, const RobotLine& line, std::string why) {
  r.last_reason = why;
  r.program.left_alone.push_back({.line = line.line, .why = std::move(why), .feeds = true});
}

void note_unread_call(RobotReading& r, const RobotLine& line, std::string why) {
  note_cutting_call(r, line, std::move(why));
  assume_of_calls(r.program, line.line);
}

bool is_stated_harmless(RobotReading& r, const RobotLine& line, std::string_view name) {
  return is_stated_harmless(r.program, r.options, line.line, name);
}

void forget_position(RobotReading& r) {
  r.state.joints.reset();
  forget_coordinates(r);
}

void enter_robot_frame(RobotReading& r, const ProgramFrame& frame) {
  const auto index = static_cast<std::uint32_t>(index_of_frame(r.program, frame));
  if (index == r.state.frame) return;
  r.state.frame = index;
  r.state.moved_by_machine = true;
  forget_coordinates(r);
}

void enter_robot_tool(RobotReading& r, std::int32_t tool, const std::optional<Pose>& tcp_mm) {
  r.state.tool = tool;
  r.state.tcp_mm = tcp_mm;
  ++r.state.tools;
  r.state.moved_by_machine = true;
  forget_coordinates(r);
}

namespace {

/// A post states with which lengths it computed the targets.
void note_kinematics(RobotReading& r, const RobotLine& line) {
  const std::string_view comment = part(r.program.text, line.comment);
  for (const std::string_view mark : {"NOMINAL KINEMATICS", "ACCURATE KINEMATICS", "ABSOLUTE ACCURACY"}) {
    const auto same = [](char a, char b) { return upper(a) == b; };
    const auto at = std::search(comment.begin(), comment.end(), mark.begin(), mark.end(), same);
    if (at == comment.end()) continue;
    const auto begin = static_cast<std::size_t>(at - comment.begin());
    add_remark(
        r.program, line.line,
        fmt::format("a comment states '{}': the errors of assembly in the machine file must be those that "
                    "the lengths of the control leave; state these with [controller] kinematics",
                    comment.substr(begin, mark.size())));
  }
}

}  // namespace

void read_robot_comment(RobotReading& r, const RobotLine& line) {
  if (empty(line.code) && empty(line.comment)) r.operation.expect_title();
  if (empty(line.comment)) return;
  note_kinematics(r, line);
  Block place;
  place.line = line.line;
  place.span = line.span;
  if (const auto force = read_force_comment(r.program.text, r.program.file, place, line.comment))
    r.state.force = force->F;
  else if (empty(line.code))
    r.operation.name(part(r.program.text, line.comment), r.state.tool);
}

void refuse_conflict_marker(const RobotReading& r, const RobotLine& line) {
  const std::string_view text = part(r.program.text, line.span);
  for (const std::string_view marker : {"<<<<<<<", "=======", ">>>>>>>", "|||||||"})
    if (text.starts_with(marker))
      refuse(r.program.file, line, line.span.begin,
             fmt::format("'{}' is a conflict marker of a version control system", marker));
}

}  // namespace counterflex
