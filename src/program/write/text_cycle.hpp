#pragma once
/// The written Z and R words of a canned cycle, which later holes repeat.
#include "program/write/text_position.hpp"
#include "program/write/text_state.hpp"

namespace counterflex {

struct CycleWords {
  WordNumber bottom, retract;
};

/// The words of `move` for the bottom at `bottom_mm` and the retract plane at `retract_mm` (empty: as in the
/// original), with Z at `start_z_mm` before the move. Z is inserted if the sticky bottom of the text differs.
/// R is never inserted. Under G91 R is relative to Z, and Z to the retract plane. Updates `written`.
CycleWords round_cycle(const Move& move, std::optional<double> start_z_mm, std::optional<double> bottom_mm,
                       std::optional<double> retract_mm, WrittenCycle& written, const WriteOptions& options);

/// Updates `written` for a cycle that is not changed.
void keep_cycle(const CycleMove& cycle, WrittenCycle& written);

/// Z at which the active series of cycles began, after `move`.
std::optional<double> cycle_initial_after(const Move& move, const TextPosition& before);

/// Z after a cycle with its retract plane at `retract_mm`.
Coordinate round_cycle_end(const Move& move, const TextPosition& before, double retract_mm,
                           const WriteOptions& options);

}  // namespace counterflex
