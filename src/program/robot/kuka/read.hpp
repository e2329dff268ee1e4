#pragma once
/// Reads the statements of KUKA KRL.
#include <map>
#include <string>
#include <vector>

#include "program/robot/kuka/lex.hpp"
#include "program/robot/kuka/loops.hpp"
#include "program/robot/kuka/routines.hpp"
#include "program/robot/reading.hpp"

namespace counterflex {

/// A target or frame that the text gives a name.
struct KrlNamed {
  Span value{};                      ///< its aggregate
  std::optional<int> computed_in{};  ///< line that computes it at run time
  int line = 0;                      ///< of a data list
};

/// A loop whose data list follows it: its targets are read where they are in the text.
struct KrlFollowedLoop {
  KrlLoop loop;
  TargetMove how;
};

struct KrlReading {
  RobotReading& robot;
  bool begun = false;                                    ///< DEF was read
  std::map<std::string, KrlNamed, std::less<>> named{};  ///< by name in upper case
  std::string tool{};                                    ///< right side of the last $TOOL
  int lost_tool = 0;                ///< line behind which the tool is not known; 0: it is
  int computed_bases = 0;           ///< how many $BASE of unknown pose were selected
  int computed_base_line = 0;       ///< the line of the last one
  std::string frame_data{};         ///< right side of the last FDAT_ACT
  std::string line_data{};          ///< right side of the last LDAT_ACT
  std::string why_no_circles{};     ///< why CIRC is not followed: $CIRC_TYPE; empty if it is
  double zone_mm = 0;               ///< $APO.CDIS, of C_DIS; 0: not known
  std::string why_not_followed{};   ///< why linear moves are not followed; empty if they are
  const bool data_lists = false;    ///< they follow the program
  const bool list_follows = false;  ///< the list follows the loop that uses it
  std::optional<KrlFollowedLoop> followed{};
  const KrlArrays& arrays;       ///< of the data lists
  const KrlFacts& facts;         ///< of the whole file
  std::vector<KrlLoop> loops{};  ///< over elements of these arrays
  std::size_t behind_loop = 0;   ///< the statements before this byte are those of a loop
  bool routine_ended = false;
  bool has_trigger = false;  ///< a TRIGGER acts at a place of the next motion
  bool has_called = false;   ///< a routine that may change variables was called
  bool in_data_list = false;
};

/// Reads the statement of `line`. Throws `InputError` with line and column.
void read_krl_statement(KrlReading& reading, const RobotLine& line);

/// Adds to `how` whether a motion statement with these last words passes its target: C_DIS, C_VEL, C_ORI, and
/// C_PTP of a rapid. Only the zone of C_DIS has a length.
TargetMove with_krl_zone(const KrlReading& reading, std::string_view words, TargetMove how);

/// LIN, PTP, CIRC and their relative forms. `head`: the keyword in upper case. `at`: the byte behind it.
void read_krl_motion(KrlReading& reading, const RobotLine& line, std::string_view head, std::size_t at);

/// The aggregate of a target or a frame that the text names, also "P[3]" and "S[3].TARGET". Empty if it is
/// not in the text, or computed at run time.
std::optional<KrlAggregate> named_aggregate(const KrlReading& reading, std::string_view name);

/// The line that makes the value of a variable one of run time; empty if the text gives it.
std::optional<int> computed_in(const KrlReading& reading, std::string_view variable);

/// Reads the names that the data lists give, before the statements that use them.
void read_names_of_lists(KrlReading& reading);

/// Reads FOR as a loop over the targets of a data list: one move for each. False for another loop. Throws
/// `InputError` if the elements of the array are not in a data list, in their order.
bool read_data_loop(KrlReading& reading, const RobotLine& line);

/// Reads a line of a data list: sizes and indices of the arrays of loops count targets.
void read_data_line(KrlReading& reading, const RobotLine& line);

/// $BASE = ..., $TOOL = ...
void assign_krl_base(KrlReading& reading, const RobotLine& line, Span value);
void assign_krl_tool(KrlReading& reading, const RobotLine& line, Span value);

/// FDAT_ACT = ..., FDAT_ACT.BASE_NO = ...
void assign_krl_frame_data(KrlReading& reading, Span value);
void assign_krl_frame_member(KrlReading& reading, std::string_view member, std::string_view value);

/// The pose of $BASE is not known from here on. Its name is "$BASE 1", the next one's "$BASE 2", also where
/// the text before it has more lines.
void forget_krl_base(KrlReading& reading, const RobotLine& line);

/// Refuses `variable`, $IPO_MODE or IPO_FRAME, with the value #TCP.
[[noreturn]] void refuse_krl_fixed_tool(const KrlReading& reading, const RobotLine& line, std::size_t at,
                                        std::string_view variable);

/// BAS(#BASE, 3) and other calls of the package that selects frames and speeds. `at`: the byte behind BAS.
void read_krl_bas(KrlReading& reading, const RobotLine& line, std::size_t at);

/// The target of an aggregate: A B C are angles about Z, Y, X. Empty if a component is not a plain number.
std::optional<RobotTarget> krl_target(const KrlAggregate& aggregate);

/// $ORI_TYPE: only #VAR turns the tool from the orientation of one target to that of the next.
void set_krl_orientation_type(KrlReading& reading, std::string_view type);

/// The speed of linear moves from here on; 0 if it is not known.
void set_krl_speed(KrlReading& reading, double metres_per_second);

/// Whether the statement is in a loop or a condition.
inline bool in_body(const KrlReading& reading) {
  return reading.robot.open_bodies > 0;
}

}  // namespace counterflex
