#pragma once
/// A block to be rewritten, and the style of it and of its program.
#include <string>

#include "program/text/lex.hpp"

namespace counterflex {

/// The style of a program, for blocks that do not show a style.
struct ProgramStyle {
  std::string separator;  ///< between words
  std::string line_end;
};

ProgramStyle style_of(const Program& program);

/// The block being rewritten, lexed again, and the style of its copies.
struct Original {
  const Program& program;
  const Dialect& dialect;
  const Move& move;
  Block block{};
  std::string separator{};
  std::string line_end{};
  bool lower_case = false;

  std::string_view text(Span span) const { return part(program.text, span); }
};

Original lex_again(const Program& program, const Move& move, const ProgramStyle& style);

bool is_axis(const Word& word);

/// A, B or C.
bool is_angle(const Word& word);

/// I, J, K or R.
bool is_centre(const Word& word);

/// G0, G1, G2 or G3.
bool is_motion(const Word& word);

/// A G code of a motion.
bool is_motion_word(const Word& word, const Dialect& dialect);

/// The block's word `upper`, or nullptr.
const Word* find_word(const Block& block, char upper);

/// `upper` in the case of the block.
char letter_of(const Original& original, char upper);

/// G`motion`, in the spelling of the block.
std::string motion_text(const Original& original, int motion);

/// The F word of a feed move, for further pieces; empty without one. Behind a G20 or G21 of the block it may
/// be read in another unit there than in the block: the feed of the first piece stays.
std::string feed_text(const Original& original);

/// '/' with the blanks behind it; empty without '/'.
std::string block_delete_text(const Original& original);

/// Whether ';' ends the block, on controls without ';' comments.
bool ends_in_semicolon(const Original& original);

}  // namespace counterflex
