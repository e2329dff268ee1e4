#pragma once
/// Reads the statements of FANUC TP.
#include <array>
#include <map>
#include <string>
#include <vector>

#include "program/robot/fanuc/positions.hpp"
#include "program/robot/reading.hpp"

namespace counterflex {

struct TpReading {
  RobotReading& robot;
  bool scanned = false;
  TpFile file{};
  TpSection section = TpSection::attributes;
  std::optional<long> frame{}, tool{};  ///< UFRAME_NUM, UTOOL_NUM; empty: not known
  std::optional<long> last_tool{};      ///< of the last target
  std::string configuration{};          ///< of the last target
  std::map<long, std::array<std::optional<double>, 6>> registers{};  ///< PR[n,1] to PR[n,6]
  std::map<long, Pose> frames{};                                     ///< UFRAME[n] with plain numbers (mm)
  std::optional<std::vector<double>> other_groups{};                 ///< of the first target
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
};

/// The motion of a statement.
TpMotion tp_motion(std::string_view text, Span code);

/// A motion statement.
void read_tp_motion(TpReading& reading, const RobotLine& line, const TpMotion& motion);

/// UFRAME_NUM, UTOOL_NUM, UFRAME[n], UTOOL[n] and PR[n]: an assignment, in upper case without blanks. False
/// for another statement.
bool read_tp_assignment(TpReading& reading, const RobotLine& line, const std::string& statement);

/// The frame with that number.
ProgramFrame tp_frame(const TpReading& reading, long number);

/// Another program or a jump may have run before the next statement: the position and the selected frames are
/// not known.
void forget_tp_state(TpReading& reading);

}  // namespace counterflex
