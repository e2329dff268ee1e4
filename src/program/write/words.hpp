#pragma once
/// The text of an edited block, and of the blocks inserted around it, word by word.
#include <string>

#include "program/write/original_block.hpp"
#include "program/write/step.hpp"
#include "program/write/text_cycle.hpp"

namespace counterflex {

/// F of a piece that does not have that of its block.
struct PieceFeed {
  double value = 0;
  int decimals = 0;
};

/// Other contents of a block than its point.
struct BesidesPoint {
  bool state_motion = false;  ///< a block without a motion word gets one
  std::optional<PieceFeed> feed{};
  CycleWords cycle{};
  double call_shift_mm = 0;  ///< shift of the heights of a drilling cycle called by the block
  /// N that replaces the block's own, an empty string: no N; not set: its own.
  std::optional<std::string> number{};
};

/// The block of `o` itself, moving by `step`, without its line end. Throws `InputError` if it would be longer
/// than the control reads.
std::string own_block(const Original& o, const Step& step, const BesidesPoint& besides, Rewritten& out);

/// MCALL with the cycle called at `move`, with shifted heights.
std::string restated_call(const Move& move, double shift_mm);

/// An inserted block that moves by `step`.
std::string inserted_block(const Original& o, const Step& step, const BesidesPoint& besides);

}  // namespace counterflex
