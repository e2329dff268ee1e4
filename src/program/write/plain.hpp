#pragma once
/// The most common case of rewriting, and the fastest: a line in which absolute coordinates change.
#include "counterflex/program/rewrite.hpp"

namespace counterflex {

/// What all blocks of a window have in common.
struct PlainRewriting {
  PlainRewriting(const Program& window, const WriteOptions& options);

  const Program& program;
  int decimals;            ///< of the options
  std::size_t line_limit;  ///< 0: none
  bool doubts_integers;    ///< words without a point may mean two things
};

/// Appends the text from byte `copied` to the end of the block of `edit` with the numbers of its axis words
/// changed, and moves `held` on, as `rewrite_block` would; false, and nothing done, for a block of another
/// kind, one that needs more than that, and numbers in an unusual style.
bool append_plain_block(const PlainRewriting& common, const MoveEdit& edit, std::size_t copied,
                        HeldPosition& held, Rewritten& out);

}  // namespace counterflex
