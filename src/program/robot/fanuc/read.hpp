#pragma once
/// Reads the statements of FANUC TP.
#include <array>
#include <map>
#include <string>
#include <vector>

#include "program/robot/fanuc/positions.hpp"
#include "program/robot/reading.hpp"

namespace counterflex {

/// UFRAME[n] that the program sets.
struct TpFrame {
  std::optional<Pose> pose_mm{};  ///< with plain numbers; empty: it may be set at run time
  int line = 0;                   ///< of the statement that may set it
};

struct TpReading {
  RobotReading& robot;
  bool scanned = false;
  TpFile file{};
  TpSection section = TpSection::attributes;
  std::optional<long> frame{}, tool{};  ///< UFRAME_NUM, UTOOL_NUM; empty: not known
  bool selects_no_frame = true;         ///< nothing before the statement selects a frame
  std::optional<long> last_tool{};      ///< of the last target
  std::string configuration{};          ///< of the last target
  std::map<long, std::array<std::optional<double>, 6>> registers{};  ///< PR[n,1] to PR[n,6]
  std::map<long, TpFrame> frames{};
  int any_frame_in = 0;  ///< line of a statement that may set any other UFRAME[n]; 0: none
  std::optional<std::vector<double>> other_groups{};  ///< of the first target
};

/// Reads the line or the statement of `line`. Throws `InputError` with line and column.
void read_tp_line(TpReading& reading, const RobotLine& line);

/// The motion types, and what a motion statement gives besides its targets.
struct TpMotion {
  char type = 0;                      ///< J, L, C, A, S; 0: not a motion
  std::vector<TpOperand> operands{};  ///< its targets: of C the auxiliary point and the end
  double feed_mm_min = 0;             ///< 0: not known
  bool passes = false;                ///< CNT1 to CNT100 and other corners; CNT0 and FINE stop
  bool acts_once = false;             ///< a word acts at the end of the motion, or gives its time
  Span refused{};                     ///< the first word that moves the tool away from the target
  Span unknown{};                     ///< the first word that is not known
  bool wrist_joint = false;           ///< Wjnt: the orientation of the tool is not controlled
  std::string action{};               ///< "CALLGRIP" of "TB .50sec,CALL GRIP"; empty: none
};

/// The motion of a statement.
TpMotion tp_motion(std::string_view text, Span code);

/// Whether a statement starts another program, by its name, by CALL, RUN or MONITOR, also under a condition
/// and at the end of a motion. It may set frames, tools and registers.
bool tp_calls(std::string_view text, Span code);

/// A motion statement, without the action at its end.
void read_tp_motion(TpReading& reading, const RobotLine& line, const TpMotion& motion);

/// UFRAME_NUM, UTOOL_NUM, UFRAME[n], UTOOL[n], PR[n] and variables of the control with these values: an
/// assignment, in upper case without blanks. False for another statement.
bool read_tp_assignment(TpReading& reading, const RobotLine& line, const std::string& statement);

/// The frame of a target with UF `number`, or with UF : F.
ProgramFrame tp_frame(const TpReading& reading, std::optional<long> number);

/// Why this frame is not known; empty if it is, or if the program does not set it.
std::string why_unknown_frame(const TpReading& reading, std::optional<long> number);

/// A called program may set the frames that have numbers.
void forget_tp_frames(TpReading& reading, int line);

/// A jump to a label in `line` may come from behind a call, or from behind or before the statements that set
/// frames.
void forget_tp_frames_at_label(TpReading& reading, int line);

/// Another program or a jump may have run before the next statement: the position and the selected frames are
/// not known.
void forget_tp_state(TpReading& reading);

}  // namespace counterflex
