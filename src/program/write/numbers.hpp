#pragma once
/// The common case of rewriting, and the fast one: a block in which no more than numbers change.
#include "program/write/held_cycle.hpp"
#include "program/write/step.hpp"

namespace counterflex {

/// Appends the block of `move`, moving by `step`, where no more than numbers of words that it has change;
/// false, and nothing appended, where more does or the line would grow beyond `line_limit` (0: none).
bool append_with_numbers(const Program& program, const Move& move, const Step& step, const CycleWords& cycle,
                         std::size_t line_limit, Rewritten& out);

}  // namespace counterflex
