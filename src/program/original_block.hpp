#pragma once
/// A block that is rewritten, and the style in which it and its program are written.
#include <string>

#include "program/lex.hpp"

namespace counterflex {

/// The style of a program, for blocks that do not show one.
struct ProgramStyle {
  std::string separator;  ///< between words
  std::string line_end;
};

ProgramStyle style_of(const Program& program);

/// The block being rewritten, lexed again, and what the copies of it share.
struct Original {
  const Program& program;
  const Dialect& dialect;
  const Move& move;
  Block block{};
  std::string separator{};
  std::string line_end{};
  bool lower_case = false;
  bool acts_itself =
      false;  ///< other words than motion, axes, F and N: it is the first piece of its own split

  std::string_view text(Span span) const { return part(program.text, span); }
};

Original lex_again(const Program& program, const Move& move, const ProgramStyle& style);

bool is_axis(const Word& word);

/// G0 or G1.
bool is_motion(const Word& word);

const Word& last_axis_word(const Block& block);

/// `upper` in the case of the block.
char letter_of(const Original& original, char upper);

/// The block's own G0 or G1; empty where it has none.
std::string motion_text(const Original& original);

/// The F word of a feed move; empty where there is none.
std::string feed_text(const Original& original);

/// '/' with the blanks that follow it; empty where there is none.
std::string block_delete_text(const Original& original);

/// Whether ';' ends the block, on controls where that is no comment.
bool ends_in_semicolon(const Original& original);

}  // namespace counterflex
