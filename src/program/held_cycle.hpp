#pragma once
/// What becomes of the Z and R words of a canned cycle, which later holes repeat.
#include "program/held_position.hpp"

namespace counterflex {

/// The bottom and the retract plane that the written text repeats, in program coordinates (mm); nothing where
/// it says none or a block that may be skipped does.
struct HeldCycle {
  std::optional<double> bottom_mm, retract_mm;
};

struct CycleWords {
  WordNumber bottom, retract;
};

/// The words of `move` that bring the bottom to `bottom_mm` and the retract plane to `retract_mm` (nothing:
/// they stay as they are), with Z at `held_z_mm` before it. Z is inserted where the bottom that the text
/// repeats is another; R never is. Under G91 R counts from Z and Z from the retract plane. Moves `held` on.
CycleWords settle_cycle(const Move& move, std::optional<double> held_z_mm, std::optional<double> bottom_mm,
                        std::optional<double> retract_mm, HeldCycle& held, const WriteOptions& options);

/// Z after a cycle whose retract plane is wanted at `retract_mm`.
Coordinate settle_cycle_end(const Move& move, std::optional<double> held_z_mm, double retract_mm,
                            const WriteOptions& options);

}  // namespace counterflex
