#pragma once
/// The new text of an edited block and of the blocks inserted around it.
#include "counterflex/program/rewrite.hpp"
#include "program/write/original_block.hpp"
#include "program/write/text_cycle.hpp"
#include "program/write/text_state.hpp"

namespace counterflex {

/// Appends the text of the block of `edit` and of the blocks inserted around it to `out.text`, without the
/// block's own line end. Counts in `out` and updates `state`. Throws as `rewrite` does.
void rewrite_block(const Program& program, const ProgramStyle& style, const MoveEdit& edit,
                   const WriteOptions& options, TextState& state, Rewritten& out);

/// Whether the text has the modal cycle called at `move`, with shifted heights; true if no cycle is called.
bool has_call(const Move& move, double shift_mm, const TextState& state);

/// Updates `state` for the block of `move`, which is not edited.
void keep_block(const Move& move, TextState& state);

/// The same if `state.restate_motion` is set: appends the block's text with a motion word, if an inserted
/// motion would apply to it otherwise.
void copy_block(const Program& program, const ProgramStyle& style, const Move& move, TextState& state,
                Rewritten& out);

/// Whether `block` ends the motion that was modal before it: no later block depends on that motion.
bool ends_motion(const Block& block, const Dialect& dialect);

}  // namespace counterflex
