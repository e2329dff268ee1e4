#pragma once
/// A block that is rewritten, and the style in which it and its program are written.
#include <string>

#include "program/text/lex.hpp"

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
      false;  ///< other words than motion, axes, centre, F and N: it is the first piece of its own split

  std::string_view text(Span span) const { return part(program.text, span); }
};

Original lex_again(const Program& program, const Move& move, const ProgramStyle& style);

bool is_axis(const Word& word);

/// I, J, K or R.
bool is_centre(const Word& word);

/// G0, G1, G2 or G3.
bool is_motion(const Word& word);

/// A G code that says how the block moves.
bool says_motion(const Word& word, const Dialect& dialect);

/// The block's word `upper`, or nullptr.
const Word* find_word(const Block& block, char upper);

/// `upper` in the case of the block.
char letter_of(const Original& original, char upper);

/// G`motion`, as the block itself writes it where it does.
std::string motion_text(const Original& original, int motion);

/// The F word of a feed move; empty where there is none.
std::string feed_text(const Original& original);

/// '/' with the blanks that follow it; empty where there is none.
std::string block_delete_text(const Original& original);

/// Whether ';' ends the block, on controls where that is no comment.
bool ends_in_semicolon(const Original& original);

}  // namespace counterflex
