#pragma once
/// What `verify` asks of a corrected program besides its moves' places.
#include "counterflex/compensation/waypoint.hpp"

namespace counterflex {

/// By move: how many lines that hold no move (the header aside) come before it. An inserted block stands
/// beside the block that it belongs to, so that both have the same count.
std::vector<std::size_t> other_lines_before(const Program& program);

/// Everything but moves and the header has to be the original's, line by line. Throws `InputError`
/// (Exit::not_compensated) at the first line of the corrected program that is not.
void check_other_lines(const Program& original, const Program& corrected);

/// Every move of the corrected program has to end where a piece ends, or where one begins (a jump), or stay
/// where it was. Throws `InputError` (Exit::not_compensated) at the first that goes anywhere else: nobody has
/// judged it.
void check_all_moves(const Job& job, const Program& corrected, const std::vector<Piece>& pieces);

}  // namespace counterflex
