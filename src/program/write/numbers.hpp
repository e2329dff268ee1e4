#pragma once
/// Fast rewriting of a block in which only numbers change.
#include "program/write/step.hpp"
#include "program/write/text_cycle.hpp"

namespace counterflex {

/// Appends the block of `move`, moving by `step`, if only numbers of its own words change. Otherwise, or if
/// the line would be longer than `line_limit` (0: no limit), returns false and appends nothing.
bool append_with_numbers(const Program& program, const Move& move, const Step& step, const CycleWords& cycle,
                         std::size_t line_limit, Rewritten& out);

}  // namespace counterflex
