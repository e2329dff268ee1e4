#pragma once
/// What the instructions of a whole Yaskawa job do with positions and frames, before they are read one by
/// one.
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "program/robot/yaskawa/positions.hpp"

namespace counterflex {

/// What a MOVC is in its circle: three MOVC one after the other are its start, a point on it, and its end.
enum class JbiCircleStep : std::uint8_t { start, auxiliary, end, unknown };

struct JbiCircle {
  std::size_t line_begin = 0;  ///< byte of the MOVC
  JbiCircleStep step = JbiCircleStep::unknown;
};

struct JbiJob {
  JbiPositions positions;
  std::vector<JbiCircle> circles;  ///< of all MOVC, in the order of the text
  std::set<long> computed_users;   ///< user coordinate systems that MFRAME changes; -1: any
  bool indexes_variables = false;  ///< P[I000] may be any variable
  bool shifts = false;             ///< it has SFTON
};

/// Kinds of instructions that are not moves.
enum class JbiFlow : std::uint8_t { none, body_begin, branch, body_end, label, call, jump, end };
JbiFlow jbi_flow(std::string_view word);

/// Reads the positions of `text` and looks through its instructions. Throws `InputError` in `file`.
JbiJob jbi_job(std::string_view text, const std::string& file);

JbiCircleStep circle_step(const JbiJob& job, std::size_t line_begin);

/// Whether the values of a position may be changed in their place: one move uses it, and nothing else.
bool has_one_use(const JbiJob& job, const JbiPosition& position);

}  // namespace counterflex
