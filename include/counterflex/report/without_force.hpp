#pragma once
/// Feed moves that are cut without a force, gathered in memory that does not grow with their number.
#include <string>
#include <vector>

#include "counterflex/forces/forces.hpp"
#include "counterflex/program/capped.hpp"

namespace counterflex {

/// All of one reason.
struct WithoutForceReason {
  std::string why;
  std::size_t moves = 0;
  double length_mm = 0;
  int first_line = 0;  ///< the least
};

/// One of them.
struct WithoutForceRow {
  int line = 0;
  double length_mm = 0;
  std::string why;
};

struct WithoutForce {
  std::size_t moves = 0;
  double length_mm = 0;
  std::vector<WithoutForceReason> reasons;  ///< as they were first met; where there are more than
                                            ///< `listed_at_most` the last one stands for all others
  Capped<WithoutForceRow> rows;
};

/// Adds the next one of the program.
void add_unforced(WithoutForce& without, const Unforced& move);

}  // namespace counterflex
