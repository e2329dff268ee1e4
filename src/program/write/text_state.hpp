#pragma once
/// State of written G-code that affects later blocks.
#include <optional>

#include "counterflex/program/rewrite.hpp"

namespace counterflex {

/// Shift (mm) of the sticky Z and R of canned cycles in the written text, relative to those of the original.
struct WrittenCycle {
  double bottom_change_mm = 0, retract_change_mm = 0;
};

/// The modal cycle of a Sinumerik in the written text.
struct WrittenCall {
  int line = 0;         ///< line of its MCALL in the original; 0: no cycle
  double shift_mm = 0;  ///< of its heights
};

struct TextState {
  TextPosition position{};
  WrittenCycle cycle{};
  /// Motion that a block without a motion word must state: that of the original, if inserted text may have
  /// changed it.
  std::optional<int> restate_motion{};
  WrittenCall call{};
};

}  // namespace counterflex
