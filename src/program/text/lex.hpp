#pragma once
/// Lines of G-code and the words in them, as spans of the text: letters, numbers, comments, and no meaning.
/// Variables and expressions are found, not worked out.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/files/input_error.hpp"
#include "counterflex/program/program.hpp"
#include "program/text/corners.hpp"
#include "program/dialect.hpp"

namespace counterflex {

/// What a coordinate counts from: Sinumerik says it by the word where it likes.
enum class Sense : std::uint8_t { modal, absolute, relative };

/// What a line of a Sinumerik says besides its words.
enum class Statement : std::uint8_t {
  none,
  call,           ///< a subprogram, or words of a move that is not read
  cycle,          ///< a cycle of the control: it leaves the modal states as they are
  modal_call,     ///< MCALL: every move calls it; bare: no more
  shift,          ///< TRANS: shifts coordinates by its words, and ends all frames before it
  added_shift,    ///< ATRANS
  turn,           ///< ROT: turns coordinates, and ends all frames before it
  added_turn,     ///< AROT
  frame,          ///< SCALE, MIRROR, ROTS, and what else stands behind TRANS or ROT; bare: no frame any more
  added_frame,    ///< ASCALE ...
  tilt,           ///< CYCLE800; bare: no more
  transformed,    ///< TRAORI ...
  transform_off,  ///< TRAFOOF
  curve,          ///< CIP, CT, splines: a motion that is not read
  not_read,       ///< axis words or G codes stand in text that is passed over
  arc_not_read,   ///< an arc whose centre is given in a form that is not read
  smoothed,       ///< COMPCAD, CYCLE832
  data,           ///< assigns to a variable of the control
  end             ///< RET
};

struct Word {
  char letter = 0;  ///< upper case
  Span span;        ///< letter and number
  Span number;
  double value = 0;  ///< 0 where it is not literal
  int decimals = 0;
  bool point = false;
  bool literal = true;  ///< a plain number, else a variable or an expression
  Sense sense = Sense::modal;
};

/// "#5=#1+2", "R1=5", "_DEPTH=-3".
struct Assignment {
  Span variable, value;
};

/// One line. Its vectors are reused from line to line.
struct Block {
  int line = 0;         ///< of the file
  int text_line = 0;    ///< of the text: another one where calls of subprograms were expanded
  int called_from = 0;  ///< line whose call a copied block comes from; 0: no copy
  Span span;            ///< without the line end
  Span line_end;        ///< empty at a last line without one
  Span block_delete;    ///< '/' and the switch number that may follow it; empty where there is none
  bool percent = false;
  std::optional<CornerSize> corner;  ///< ",R2." or ",C1.", in the units of the program; NaN: an expression
  bool part_name = false;  ///< the line is the name of a program
  bool assigns = false;    ///< holds '#1=', "R1="
  bool assigns_by_name = false;  ///< "_DEPTH=5", "MEAS=1": a variable, or a word that is not known
  Statement statement = Statement::none;
  bool statement_is_bare = false;  ///< nothing follows its name
  Span statement_text;             ///< of a call, from its name to the comment
  bool has_sense = false;          ///< a word says what it counts from
  Span flow_name;                  ///< of an O-word: "100" or "<name>"
  Span flow_keyword;               ///< of a line of flow: "sub", "GOTO"; empty where it is none
  std::optional<Word> angle;  ///< of a Sinumerik: ANG=, the direction of a line whose end is half said
  std::vector<Word> words;
  std::vector<Assignment> assignments;  ///< to variables; of `assigns` and `assigns_by_name`
  std::vector<Span> comments;  ///< what stands inside the comment characters
};

inline std::string_view part(std::string_view text, Span span) {
  return text.substr(span.begin, span.end - span.begin);
}
/// The number of a word that counts (T, N, H, P), without what is no whole; far beyond any count it stays
/// there.
long count_of(const Word& word);

inline bool empty(Span span) {
  return span.begin == span.end;
}

/// Whether a line says anything to the control.
inline bool says_something(const Block& block) {
  return !block.words.empty() || block.assigns || block.statement != Statement::none ||
         !empty(block.flow_keyword);
}

/// An O-number alone on its line.
inline bool is_program_number(const Block& block) {
  return block.words.size() == 1 && block.words[0].letter == 'O';
}

/// An O-number at the beginning of a block that moves nothing.
bool begins_with_program_number(const Block& block);

/// Advances `block` to the line after `block.line_end`; false at the end of `text`. A default Block stands
/// before the first line.
bool next_line(std::string_view text, Block& block);

/// Finds the words and comments of the line at `block.span`. Throws `InputError` for what is no G-code.
void lex(std::string_view text, const std::string& file, const Dialect& dialect, Block& block);

/// Throws an `InputError` that points at byte `at` of `block`.
[[noreturn]] void refuse(const std::string& file, const Block& block, std::size_t at,
                         const std::string& message, Exit exit = Exit::program_text);

}  // namespace counterflex
