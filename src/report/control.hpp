#pragma once
/// What a control may make of a program: blocks too short in time, lines too long, paths smoothed.
#include <vector>

#include "counterflex/report/run_tally.hpp"

namespace counterflex {

/// Adds the feed moves of a window that take less than the limit of `blocks` at programmed feeds.
void add_short_blocks(ShortBlocks& blocks, const Program& window);

/// Of the original program and, where one was written, of the corrected one.
ControlFacts control_facts(const Overview& program, const RunTally& tally);

/// What of it is worth a warning; `correction` is the largest one (none: not known).
std::vector<Remark> control_warnings(const ControlFacts& control, const std::optional<Largest>& correction);

}  // namespace counterflex
