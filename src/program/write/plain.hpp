#pragma once
/// Fast rewriting of the most common lines, in which absolute coordinates change.
#include "counterflex/program/rewrite.hpp"

namespace counterflex {

/// Values shared by all blocks of a window.
struct PlainRewriting {
  PlainRewriting(const Program& window, const WriteOptions& options);

  const Program& program;
  int decimals;             ///< of the options
  std::size_t line_limit;   ///< 0: no limit
  bool integers_ambiguous;  ///< words without a decimal point are ambiguous
};

/// Appends the text from byte `copied` to the end of the block of `edit` with changed numbers of its axis
/// words, and updates `position`, as `rewrite_block` would. False, without effect, for other kinds of blocks,
/// for blocks that need other changes, and for numbers in an unusual style.
bool append_plain_block(const PlainRewriting& common, const MoveEdit& edit, std::size_t copied,
                        TextPosition& position, Rewritten& out);

}  // namespace counterflex
