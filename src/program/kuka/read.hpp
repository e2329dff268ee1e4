#pragma once
/// Reads the statements of KUKA KRL.
#include <map>
#include <string>

#include "program/kuka/lex.hpp"
#include "program/robot/reading.hpp"

namespace counterflex {

/// A target or frame that the text gives a name.
struct KrlNamed {
  KrlAggregate value;
  std::optional<int> computed_in{};  ///< line that computes it at run time
};

struct KrlReading {
  RobotReading& robot;
  bool begun = false;                                    ///< DEF was read
  std::map<std::string, KrlNamed, std::less<>> named{};  ///< by name in upper case
  std::string tool{};                                    ///< right side of the last $TOOL
  std::string frame_data{};                              ///< right side of the last FDAT_ACT
  bool turns_with_path = false;                          ///< $CIRC_TYPE=#PATH
  std::string why_not_followed{};  ///< why linear moves are not followed; empty if they are
};

/// Reads the statement of `line`. Throws `InputError` with line and column.
void read_krl_statement(KrlReading& reading, const RobotLine& line);

/// LIN, PTP, CIRC and their relative forms. `head`: the keyword in upper case. `at`: the byte behind it.
void read_krl_motion(KrlReading& reading, const RobotLine& line, std::string_view head, std::size_t at);

/// $BASE = ..., $TOOL = ...
void assign_krl_base(KrlReading& reading, const RobotLine& line, Span value);
void assign_krl_tool(KrlReading& reading, const RobotLine& line, Span value);

/// BAS(#BASE, 3) and other calls of the package that selects frames and speeds. `at`: the byte behind BAS.
void read_krl_bas(KrlReading& reading, const RobotLine& line, std::size_t at);

/// The target of an aggregate: A B C are angles about Z, Y, X. Empty if a component is not a plain number.
std::optional<RobotTarget> krl_target(const KrlAggregate& aggregate);

/// The speed of linear moves from here on; 0 if it is not known.
void set_krl_speed(KrlReading& reading, double metres_per_second);

/// Whether the statement is in a loop or a condition.
inline bool in_body(const KrlReading& reading) {
  return reading.robot.open_bodies > 0;
}

}  // namespace counterflex
