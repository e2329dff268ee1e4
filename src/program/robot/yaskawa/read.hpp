#pragma once
/// Reads the instructions of Yaskawa jobs.
#include <optional>
#include <string>
#include <vector>

#include "program/robot/reading.hpp"
#include "program/robot/yaskawa/job.hpp"
#include "program/robot/yaskawa/motion.hpp"

namespace counterflex {

/// The auxiliary point of a circle, until its end is read.
struct JbiAuxiliary {
  RobotTarget target;
  std::uint32_t frame = 0;
  long tool = 0;
  std::string why{};  ///< why the circle is not followed; empty if it is
};

struct JbiReading {
  RobotReading& robot;
  std::optional<JbiJob> job{};
  std::vector<std::uint32_t> followed{};  ///< by position: the number of followed moves that use it
  std::vector<Span> numbers{};            ///< of C, BC and EC in the instructions, in the order of the text
  std::optional<long> tool{};             ///< of the last target
  double speed_mm_s = 0;                  ///< of SPEED; 0 if it is not known
  bool is_shifted = false;                ///< SFTON is active, or may be
  int call_line = 0;                      ///< of the first call, which may change position variables
  std::optional<JbiAuxiliary> auxiliary{};
  bool is_relative = false;  ///< ATTR RJ
};

/// Reads the statement of `line`. Throws `InputError` with line and column.
void read_jbi_statement(JbiReading& reading, const RobotLine& line);

/// MOVJ, MOVL, MOVC, MOVS, IMOV.
void read_jbi_move(JbiReading& reading, const RobotLine& line);

/// A position that a step moves to.
struct JbiTarget {
  RobotTarget numbers{};
  std::optional<std::size_t> position{};  ///< index into JbiPositions::list
  bool is_pulse = false;
  ProgramFrame frame{};
  long tool = 0;
  std::string why{};  ///< why it is not followed; empty if it is
};

/// The target of `motion`. Throws `InputError` for a position that the job does not have.
JbiTarget jbi_target(const JbiReading& reading, const RobotLine& line, const JbiMotion& motion);

/// Texts outside of moves that follow the number of positions: the counts of NPOS, the names of positions,
/// and whole lines of positions that are judged by their moves. The line of a position that another
/// instruction uses does not change.
std::vector<Span> jbi_counts(const JbiReading& reading);

}  // namespace counterflex
