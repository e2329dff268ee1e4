#pragma once
/// The text of one edited block, and of the blocks inserted around it, word by word.
#include <string>

#include "program/write/held_cycle.hpp"
#include "program/write/original_block.hpp"
#include "program/write/step.hpp"

namespace counterflex {

/// What a block says besides the point it moves to.
struct BesidesPoint {
  bool state_motion = false;             ///< a block without a motion word must say it
  std::optional<double> feed_per_min{};  ///< G93: F of this piece
  CycleWords cycle{};
  double call_shift_mm = 0;  ///< of the heights of a drilling cycle that the block calls
  std::optional<std::string> number{};  ///< N in place of the block's own, empty: no N; none: its own
};

/// The block of `o` itself, moving by `step`, without its line end. Throws `InputError` where it would be
/// longer than the control reads.
std::string own_block(const Original& o, const Step& step, const BesidesPoint& besides, Rewritten& out);

/// MCALL with the cycle that is called at `move`, its heights shifted.
std::string restated_call(const Move& move, double shift_mm);

/// An inserted block that moves by `step`.
std::string inserted_block(const Original& o, const Step& step, const BesidesPoint& besides);

}  // namespace counterflex
