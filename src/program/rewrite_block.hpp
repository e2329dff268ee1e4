#pragma once
/// The new text of one edited block and of the blocks inserted around it.
#include <string>

#include "counterflex/program/rewrite.hpp"
#include "program/original_block.hpp"

namespace counterflex {

/// Appends the text of the block of `edit` and of the blocks inserted around it to `out.text`, without the
/// block's own line end, counts in `out`, and moves `held` to the position that the text then holds. Throws
/// as `rewrite` does.
void rewrite_block(const Program& program, const ProgramStyle& style, const MoveEdit& edit,
                   const WriteOptions& options, HeldPosition& held, Rewritten& out);

}  // namespace counterflex
