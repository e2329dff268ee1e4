#pragma once
/// What becomes of the Z and R words of a canned cycle, which later holes repeat.
#include "program/write/held_position.hpp"
#include "program/write/text_state.hpp"

namespace counterflex {

struct CycleWords {
  WordNumber bottom, retract;
};

/// The words of `move` that bring the bottom to `bottom_mm` and the retract plane to `retract_mm` (nothing:
/// where the original has them), with Z at `held_z_mm` before it. Z is inserted where the bottom that the
/// text repeats is another; R never is. Under G91 R counts from Z and Z from the retract plane. Moves `held`
/// on.
CycleWords settle_cycle(const Move& move, std::optional<double> held_z_mm, std::optional<double> bottom_mm,
                        std::optional<double> retract_mm, HeldCycle& held, const WriteOptions& options);

/// Moves `held` on over a cycle that stays as the text has it.
void pass_cycle(const CycleMove& cycle, HeldCycle& held);

/// Z where the series of cycles that acts after `move` began.
std::optional<double> cycle_initial_after(const Move& move, const HeldPosition& before);

/// Z after a cycle whose retract plane is wanted at `retract_mm`.
Coordinate settle_cycle_end(const Move& move, const HeldPosition& before, double retract_mm,
                            const WriteOptions& options);

}  // namespace counterflex
