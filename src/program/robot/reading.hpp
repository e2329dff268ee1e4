#pragma once
/// What the readers of all robot languages share: the state between statements, and how a statement becomes a
/// move.
#include <string>

#include "counterflex/program/program.hpp"
#include "counterflex/program/read_program.hpp"
#include "program/robot/line.hpp"
#include "program/robot/target.hpp"
#include "program/text/operation.hpp"

namespace counterflex {

/// State of the robot between statements. Position and orientation are those of the tool in the active frame.
struct RobotState {
  Vector3 position_mm = Vector3::Zero();
  std::array<bool, 3> known_position{};
  OrientationNumbers orientation{};
  std::array<bool, 4> known_orientation{};  ///< by number
  std::array<std::optional<double>, 6> external{};
  std::array<int, 6> external_unknown_in{};  ///< line of the first target before any that gives the axis
  /// The last ones of joint targets.
  std::array<std::optional<ExternalAxis>, 6> external_at_joints{};
  /// A joint target after which no statement moved the robot; the position is unknown until the next move.
  std::optional<JointPlace> joints{};
  int joints_line = 0;                        ///< of that target
  bool at_joints = false;                     ///< the position is that of a joint target
  int tools = 0;                              ///< how often a tool was selected
  std::optional<Pose> tcp_mm{};               ///< of the tool, if the program gives its numbers
  bool moved_by_machine = false;              ///< since the last move: a joint target, another frame or tool
  LengthUnit unit = LengthUnit::millimetres;  ///< of the numbers of positions in the text
  double feed_mm_min = 0;
  double spindle_rpm = 0;
  std::int32_t tool = 0;
  std::uint32_t frame = 0;  ///< index into Program::frames
  std::optional<Vector6> force{};
};

/// State of a reader. `program` grows.
struct RobotReading {
  Program& program;
  const ReadOptions& options;
  OrientationForm form;  ///< of the language
  bool turns = true;     ///< the program gives orientations; else its moves have positions alone
  RobotState state{};
  CurrentOperation operation{};
  int open_bodies = 0;  ///< loops and conditions around the statement: it may run never or several times
  std::string last_reason{};   ///< of the last uncorrected block
  bool in_zone = false;        ///< the zone at the last target has a length
  bool began_in_zone = false;  ///< the same of the target before it
  bool ended = false;
};

/// How a statement moves to its target.
struct TargetMove {
  Motion motion = Motion::feed;  ///< a joint move to a Cartesian target is a rapid
  bool relative = false;         ///< the numbers of the position are differences from the last target
  StatedTurns stated_turns = StatedTurns::none;
  bool passes = false;       ///< the robot does not stop at the target: C_DIS, a zone, CNT
  bool rounds = true;        ///< where it passes; false for APT, which leaves that to the post
  TargetZone zone{};         ///< where it passes; without words: corrections do not change it
  bool stays_whole = false;  ///< something acts at a place of this motion: no other may be inserted
};

/// Begins a move in the state before the statement of `line`.
Move begin_robot_move(RobotReading& reading, const RobotLine& line, Motion motion);

/// Pose of the tool frame at joint values in coordinates of `frame`, with the tool that is selected. Empty
/// without kinematics, and where the place is not known.
std::optional<Pose> pose_at_joints(const RobotReading& reading, const JointPlace& joints,
                                   const ProgramFrame& frame);

/// Moves the state to `target` and completes `move`, which begins at the last one. Numbers that the target
/// does not have keep their last value.
void end_at_target(RobotReading& reading, const RobotTarget& target, const TargetMove& how, Move& move);

/// Gives `move`, which ends at its target, the arc through an auxiliary point. False if the arc is not known:
/// an end or a coordinate of the point is not, or the three points lie nearly on a line.
bool go_through(const RobotTarget& point, Move& move);

/// Gives the arc of `move` the limits that its control has for turns of the tool. False if the arc itself
/// does not keep them.
bool limit_turn(const ArcTurnLimits& limits, Move& move);

/// The same as `end_at_target` with a new move, which is added to the program.
void add_target_move(RobotReading& reading, const RobotLine& line, const RobotTarget& target,
                     const TargetMove& how);

/// A statement that moves the robot and is not followed: no edit can shift its end.
void add_unfollowed_move(RobotReading& reading, const RobotLine& line, std::string why);

/// A statement that moves the robot to joint positions. It is not changed. The position is that of `joints`
/// if the options have the kinematics of the robot, else it is unknown until the next full target.
void add_joint_move(RobotReading& reading, const RobotLine& line, std::string why,
                    const std::optional<JointPlace>& joints = {});

/// Lists an uncorrected statement. Of a run of equal reasons only the first is listed.
void note_uncorrected(RobotReading& reading, const RobotLine& line, std::string why);

/// The call of a routine that may cut: a feed move of unknown length.
void note_cutting_call(RobotReading& reading, const RobotLine& line, std::string why);

/// The same of a routine that is not read, with the remark that states what it must not change.
void note_unread_call(RobotReading& reading, const RobotLine& line, std::string why);

/// Whether the machine file states that the called program leaves the robot and its state as they are. Adds
/// a remark with its name.
bool is_stated_harmless(RobotReading& reading, const RobotLine& line, std::string_view name);

/// The position and orientation of the tool are unknown until they are programmed.
void forget_position(RobotReading& reading);

/// Selects the frame of the next targets. If it is another one, the position in it is unknown.
void enter_robot_frame(RobotReading& reading, const ProgramFrame& frame);

/// Selects the tool, 0 for an unknown number. The position of its centre is unknown.
void enter_robot_tool(RobotReading& reading, std::int32_t tool, const std::optional<Pose>& tcp_mm = {});

/// Reads the comment of `line`: a FORCE comment, or the name of an operation if it is alone in its line.
/// Throws `InputError` (ErrorKind::machine_or_force) for a malformed FORCE comment.
void read_robot_comment(RobotReading& reading, const RobotLine& line);

/// Throws `InputError` at a conflict marker of a version control system.
void refuse_conflict_marker(const RobotReading& reading, const RobotLine& line);

}  // namespace counterflex
