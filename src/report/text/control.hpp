#pragma once
/// Checks of a program against limits of the control: blocks too short in time, lines too long, smoothed
/// paths.
#include <vector>

#include "counterflex/report/run_tally.hpp"

namespace counterflex {

/// Adds the feed moves of a window that take less than the limit of `blocks` at programmed feeds.
void add_short_blocks(ShortBlocks& blocks, const Program& window);

/// For the original program and, if written, the corrected one.
ControlFacts control_facts(const Overview& program, const RunTally& tally);

/// Warnings about it; `correction` is the largest correction, if known.
std::vector<Remark> control_warnings(const ControlFacts& control, const std::optional<Largest>& correction);

}  // namespace counterflex
