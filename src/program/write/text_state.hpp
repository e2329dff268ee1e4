#pragma once
/// What written G-code leaves to the blocks that follow.
#include <optional>

#include "counterflex/program/rewrite.hpp"

namespace counterflex {

/// How far (mm) the sticky Z and R of canned cycles in the written text lie from those that the original
/// repeats.
struct HeldCycle {
  double bottom_change_mm = 0, retract_change_mm = 0;
};

/// The modal cycle of a Sinumerik in the written text.
struct HeldCall {
  int line = 0;         ///< of its MCALL in the original; 0: none
  double shift_mm = 0;  ///< of its heights
};

struct TextState {
  HeldPosition held{};
  HeldCycle cycle{};
  std::optional<int> restate_motion{};  ///< what a block that relies on the modal motion must say: that of
                                        ///< the original, where inserted text may have left another
  HeldCall call{};
};

}  // namespace counterflex
