#pragma once
/// What a control may make of a program: blocks too short in time, lines too long, paths smoothed.
#include <vector>

#include "counterflex/report/report.hpp"

namespace counterflex {

/// Feed moves of `program` that take less than `limit_ms` at programmed feeds.
ShortBlocks short_blocks(const Program& program, double limit_ms);

/// Of the original program and, where one was written, of `corrected`, its text.
ControlFacts control_facts(const Job& job, const RunFacts& facts, const std::string* corrected);

/// What of it is worth a warning; `correction` is the largest one (none: not known).
std::vector<Remark> control_warnings(const ControlFacts& control, const std::optional<Largest>& correction);

}  // namespace counterflex
