#pragma once
/// Inserts positions into the written text of a Yaskawa job, and counts the numbers of the others on.
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "program/robot/yaskawa/job.hpp"

namespace counterflex {

/// A position that the written steps need.
struct JbiNewPosition {
  JbiName origin;          ///< the position that it is a copy of; one of P becomes a C
  std::string values{};    ///< text behind '='
  bool is_copy = false;    ///< of an inserted step; else the step that had `origin` moves to it
  std::uint32_t name = 0;  ///< its number in the written instructions, until it gets its own
};

/// The first number that no position of the job has. New positions have such numbers until all are known.
std::uint32_t first_free_number(const JbiPositions& positions);

/// `text` with `added` before the positions of which they are copies, so that the numbers of C, BC and EC
/// follow the order of the steps, if they did so before. NPOS counts them. If all steps of a position C moved
/// away from it, the first one keeps it: a control refuses a position without a step.
std::string with_new_positions(const std::string& text, const std::string& file,
                               const std::vector<JbiNewPosition>& added);

}  // namespace counterflex
