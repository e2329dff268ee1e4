#pragma once
/// The new text of one edited block and of the blocks inserted around it.
#include "counterflex/program/rewrite.hpp"
#include "program/write/held_cycle.hpp"
#include "program/write/original_block.hpp"
#include "program/write/text_state.hpp"

namespace counterflex {

/// Appends the text of the block of `edit` and of the blocks inserted around it to `out.text`, without the
/// block's own line end, counts in `out`, and moves `state` to what the text then holds. Throws as `rewrite`
/// does.
void rewrite_block(const Program& program, const ProgramStyle& style, const MoveEdit& edit,
                   const WriteOptions& options, TextState& state, Rewritten& out);

/// Whether the text holds the modal cycle that is called at `move`, its heights shifted; true where none is called.
bool holds_call(const Move& move, double shift_mm, const TextState& state);

/// Moves `state` on over the block of `move`, which is not edited and stays as it is.
void pass_block(const Move& move, TextState& state);

/// The same where `state.restate_motion`: appends the block's text, which says its motion where it would
/// otherwise take an inserted one's.
void copy_block(const Program& program, const ProgramStyle& style, const Move& move, TextState& state,
                Rewritten& out);

/// Whether no block behind the line of `block` can rely on a motion that was modal before it.
bool ends_motion(const Block& block, const Dialect& dialect);

}  // namespace counterflex
