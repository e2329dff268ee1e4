// The motion functions: Universal Robots, "The URScript Programming Language", module motion. Poses are in
// the base of the robot, in metres and with the rotation vector (axis-angle) of the tool. movel and movep
// move the tool linearly in tool space: between two targets it turns about one fixed axis. movec with mode 0
// interpolates the orientation from the current to the target pose.
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "program/robot/ur/read.hpp"
#include "program/text/lex.hpp"

namespace counterflex {
namespace {

constexpr double seconds_of_minute = 60;
constexpr double default_speed = 0.25;  // m/s

constexpr std::string_view in_ur_body =
    "a loop, a condition or a function may run the statement never or several times";

enum class TargetKind { pose, joints, computed };

/// The target of a motion.
struct UrTarget {
  TargetKind kind = TargetKind::computed;
  RobotTarget numbers{};
  ProgramFrame frame{};
  std::optional<JointPlace> joints{};  ///< if all of its six numbers are known
};

}  // namespace

Pose ur_pose_mm(const UrPose& pose) {
  Pose X;
  OrientationNumbers vector{};
  for (std::size_t i = 0; i < 3; ++i) {
    X.p[static_cast<Eigen::Index>(i)] = pose.numbers[i].value * ur_length_mm;
    vector[i] = pose.numbers[i + 3].value;
  }
  X.R = rotation_of(OrientationForm::rotation_vector, vector);
  return X;
}

namespace {

UrTarget target_of(const UrPose& pose) {
  UrTarget target{.kind = TargetKind::pose};
  for (std::size_t i = 0; i < 3; ++i) {
    target.numbers.position[i] = pose.numbers[i];
    target.numbers.position[i]->value *= ur_length_mm;
    target.numbers.orientation[i] = pose.numbers[i + 3];
  }
  return target;
}

UrTarget target_at(const UrReading& r, Span value);

/// Whether `value` is a variable that the text never assigns: a feature of the installation.
bool is_feature(const UrReading& r, Span value) {
  const std::string_view text = r.robot.program.text;
  const Span name = ur_name_at(text, value.begin, value.end);
  if (empty(name) || name.end != value.end) return false;
  const auto found = r.names.variables.find(part(text, name));
  return found == r.names.variables.end() || found->second.values.empty();
}

/// pose_trans(ref, p): p is a pose in the frame ref.
UrTarget target_in_frame(const UrReading& r, const UrCall& call) {
  const std::string_view text = r.robot.program.text;
  const Span ref = call.arguments[0].value;
  const auto frame = ur_pose(text, ur_resolved(text, r.names, ref));
  UrTarget target = target_at(r, call.arguments[1].value);
  if (target.kind != TargetKind::pose || target.frame != ProgramFrame{}) return {};
  if (!frame && !is_feature(r, ref)) return {};
  target.frame.work_offset = ur_pose(text, ref) ? "pose_trans" : part(text, ref);
  if (frame) target.frame.pose_mm = ur_pose_mm(*frame);
  return target;
}

/// Joint values.
std::optional<JointPlace> joints_at(std::string_view text, Span list) {
  const auto numbers = ur_list(text, list);
  if (!numbers) return std::nullopt;
  JointPlace place;
  for (std::size_t i = 0; i < numbers->size(); ++i) place.joints[i] = (*numbers)[i].value;
  return place;
}

UrTarget target_at(const UrReading& r, Span value) {
  const std::string_view text = r.robot.program.text;
  const Span resolved = ur_resolved(text, r.names, value);
  if (const auto pose = ur_pose(text, resolved)) return target_of(*pose);
  if (part(text, resolved).starts_with('['))
    return {.kind = TargetKind::joints, .joints = joints_at(text, resolved)};
  // A variable may hold a position of the tool or of the joints, and its expression other variables.
  if (resolved.begin != value.begin) return {};
  const auto call = ur_call_at(text, value.begin, value.end);
  if (!call || call->span.end != value.end) return {};
  const std::string_view name = part(text, call->name);
  const std::size_t count = call->arguments.size();
  if (r.names.functions.contains(name)) return {};
  if (name == "pose_trans" && count == 2) return target_in_frame(r, *call);
  // It gives joint positions at which the tool is at this pose.
  if (name == "get_inverse_kin" && (count == 1 || count == 2)) {
    UrTarget target = target_at(r, call->arguments[0].value);
    return target.kind == TargetKind::pose ? target : UrTarget{};
  }
  return {};
}

/// A joint target as a pose in the base of the robot, if the kinematics are known. `operand`, which a
/// corrected pose replaces, is the text of each of its numbers.
UrTarget at_pose(const UrReading& r, const UrTarget& target, Span operand) {
  if (!target.joints) return target;
  const auto X = pose_at_joints(r.robot, *target.joints, {});
  if (!X) return target;
  const OrientationNumbers vector =
      numbers_of(OrientationForm::rotation_vector, X->R, r.robot.state.orientation);
  UrTarget posed{.kind = TargetKind::pose};
  const int decimals = resolution_decimals(LengthUnit::metres);
  for (std::size_t i = 0; i < 3; ++i) {
    posed.numbers.position[i] = RobotNumber{operand, X->p[static_cast<Eigen::Index>(i)], decimals};
    posed.numbers.orientation[i] = RobotNumber{operand, vector[i], decimals};
  }
  return posed;
}

/// The number of an argument: `otherwise` without it, empty if it is computed.
std::optional<double> number_of(const UrReading& r, const UrCall& call, std::string_view name,
                                double otherwise) {
  const std::string_view text = r.robot.program.text;
  const UrArgument* argument = ur_argument(text, call, name);
  return argument ? ur_constant(text, r.names, argument->value) : otherwise;
}

Span value_of(const UrReading& r, const RobotLine& line, const UrCall& call, std::string_view name) {
  const std::string_view text = r.robot.program.text;
  const UrArgument* argument = ur_argument(text, call, name);
  // movej has q or a pose.
  if (argument == nullptr && name == "pose") argument = ur_argument(text, call, "q");
  if (argument != nullptr) return argument->value;
  refuse(r.robot.program.file, line, call.name.begin,
         fmt::format("{} has no target: write {}(p[0.1, 0.2, 0.3, 0, 0, 0], ...)", part(text, call.name),
                     part(text, call.name)));
}

/// The zone of r; without a length where r is computed.
TargetZone zone_of(const UrReading& r, const UrCall& call, std::optional<double> radius) {
  const UrArgument* argument = ur_argument(r.robot.program.text, call, "r");
  if (argument == nullptr || !radius) return {};
  return {.words = argument->value, .length_mm = ur_length_mm * *radius, .must_not_overlap = true};
}

/// Whether the robot comes to the target, and stops there.
bool stops_for_sure(const UrReading& r, const TargetZone& zone) {
  return !in_body(r) && !r.unknown_zone && zone.length_mm == 0;
}

void read_joint_move(UrReading& r, const RobotLine& line, const UrTarget& target, const TargetZone& zone) {
  if (target.kind == TargetKind::joints)
    return add_joint_move(r.robot, line, "movej moves to joint positions",
                          stops_for_sure(r, zone) ? target.joints : std::nullopt);
  if (target.kind == TargetKind::computed)
    return add_joint_move(r.robot, line, "the target of movej is computed at run time");
  if (in_body(r)) return add_joint_move(r.robot, line, std::string(in_ur_body));
  enter_robot_frame(r.robot, target.frame);
  r.robot.state.feed_mm_min = 0;
  add_target_move(r.robot, line, target.numbers,
                  {.motion = Motion::rapid, .passes = zone.length_mm > 0, .zone = zone});
}

/// Properties of a move in tool space besides its target.
struct UrManner {
  TargetZone zone;
  std::optional<double> time, speed;  ///< s, m/s; empty: computed
  bool unknown_zone_before = false;
};

/// The move to `target`. A copy of a statement that states its time would take that time, too; and zones must
/// not overlap.
Move move_to(UrReading& r, const RobotLine& line, const UrTarget& target, const UrManner& manner) {
  const bool timed = !manner.time || *manner.time != 0;
  r.robot.state.feed_mm_min = timed ? 0 : manner.speed.value_or(0) * ur_length_mm * seconds_of_minute;
  Move move = begin_robot_move(r.robot, line, Motion::feed);
  end_at_target(r.robot, target.numbers, {.passes = manner.zone.length_mm > 0, .zone = manner.zone}, move);
  if (timed && manner.time && *manner.time > 0) {
    move.feed_mode = FeedMode::inverse_time;
    move.feed_per_min = seconds_of_minute / *manner.time;
  }
  if (timed || manner.unknown_zone_before) move.may_split = move.may_jump = false;
  return move;
}

void read_line(UrReading& r, const RobotLine& line, std::string_view head, const UrTarget& target,
               const UrManner& manner) {
  if (target.kind == TargetKind::joints) {
    add_joint_move(r.robot, line,
                   fmt::format("{} moves to joint positions, and where these are is not known", head));
    r.robot.program.left_alone.back().feeds = true;
    return;
  }
  if (target.kind == TargetKind::computed)
    return add_unfollowed_move(r.robot, line, fmt::format("the target of {} is computed at run time", head));
  if (in_body(r)) return add_unfollowed_move(r.robot, line, std::string(in_ur_body));
  enter_robot_frame(r.robot, target.frame);
  r.robot.program.moves.push_back(move_to(r, line, target, manner));
}

std::string why_not_followed(const UrReading& r, const UrTarget& via, const UrTarget& end,
                             std::optional<double> mode) {
  if (in_body(r)) return std::string(in_ur_body);
  if (via.kind == TargetKind::joints || end.kind == TargetKind::joints)
    return "movec moves to joint positions";
  if (via.kind != TargetKind::pose || end.kind != TargetKind::pose)
    return "a point of movec is computed at run time";
  if (via.frame != end.frame) return "the points of movec are in two frames";
  if (!mode || *mode != 0) return "movec turns the tool with the path (mode)";
  return "";
}

/// Whether a line can take the place of movec: its two points are side by side, and mode is behind them.
bool may_become_line(std::string_view text, const UrCall& call) {
  const UrArgument *via = ur_argument(text, call, "pose_via"), *to = ur_argument(text, call, "pose_to"),
                   *mode = ur_argument(text, call, "mode");
  return via + 1 == to && (mode == nullptr || mode > to);
}

void read_circle(UrReading& r, const RobotLine& line, const UrCall& call, const UrManner& manner) {
  const UrTarget via = target_at(r, value_of(r, line, call, "pose_via")),
                 end = target_at(r, value_of(r, line, call, "pose_to"));
  if (const std::string why = why_not_followed(r, via, end, number_of(r, call, "mode", 0)); !why.empty())
    return add_unfollowed_move(r.robot, line, why);
  enter_robot_frame(r.robot, end.frame);
  Move move = move_to(r, line, end, manner);
  if (!may_become_line(r.robot.program.text, call)) move.may_split = move.may_jump = false;
  if (all_known(move.known_end) && go_through(via.numbers, move)) {
    r.robot.program.moves.push_back(std::move(move));
    return;
  }
  forget_position(r.robot);
  add_unfollowed_move(r.robot, line,
                      "the circle of movec is not known: its start is not, or its points lie on a line");
}

}  // namespace

void read_ur_motion(UrReading& r, const RobotLine& line, const UrCall& call) {
  const std::string_view head = part(r.robot.program.text, call.name);
  const std::optional<double> radius = number_of(r, call, "r", 0);
  const UrManner manner{zone_of(r, call, radius), number_of(r, call, "t", 0),
                        number_of(r, call, "v", default_speed), r.unknown_zone};
  r.unknown_zone = !radius;
  if (head == "movec") return read_circle(r, line, call, manner);
  const UrTarget target = target_at(r, value_of(r, line, call, "pose"));
  if (head == "movej") return read_joint_move(r, line, target, manner.zone);
  read_line(r, line, head, at_pose(r, target, value_of(r, line, call, "pose")), manner);
}

}  // namespace counterflex
