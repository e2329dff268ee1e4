#pragma once
/// Lines of G-code and their words, as spans of the text: letters, numbers and comments, without a meaning.
/// Variables and expressions are found, but not evaluated.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/files/input_error.hpp"
#include "counterflex/program/program.hpp"
#include "program/dialect.hpp"
#include "program/text/corners.hpp"

namespace counterflex {

/// Mode of a coordinate. A Sinumerik may give it for each word.
enum class DistanceMode : std::uint8_t { modal, absolute, relative };

/// The statement of a Sinumerik line, in addition to its words.
enum class Statement : std::uint8_t {
  none,
  call,           ///< a subprogram, or a motion that is not supported
  cycle,          ///< a cycle of the control; modal states do not change
  modal_call,     ///< MCALL: every move calls it; alone: ends it
  shift,          ///< TRANS: shifts coordinates by its words, and ends earlier frames
  added_shift,    ///< ATRANS
  turn,           ///< ROT: rotates coordinates, and ends earlier frames
  added_turn,     ///< AROT
  frame,          ///< SCALE, MIRROR, ROTS, and other words behind TRANS or ROT; alone: ends all frames
  added_frame,    ///< ASCALE ...
  tilt,           ///< CYCLE800; alone: ends it
  transformed,    ///< TRAORI ...
  transform_off,  ///< TRAFOOF
  curve,          ///< CIP, CT, splines: a motion that is not supported
  not_read,       ///< skipped text has axis words or G codes
  smoothed,       ///< COMPCAD, CYCLE832
  data,           ///< an assignment to a variable of the control
  end             ///< RET
};

struct Word {
  char letter = 0;  ///< upper case
  Span span;        ///< letter and number
  Span number;
  double value = 0;  ///< 0 if it is not literal
  int decimals = 0;
  bool point = false;
  bool literal = true;  ///< a plain number, else a variable or an expression
  DistanceMode mode = DistanceMode::modal;
};

/// "#5=#1+2", "R1=5", "_DEPTH=-3".
struct Assignment {
  Span variable, value;
  Span type{};  ///< of DEF and PROC: INT, REAL
};

/// A word of a Sinumerik that sets a feed or a speed by name: "S1=4000", "FB=100", "OVR=50", "SETMS(2)".
struct SpeedWord {
  Span name;
  Word value;  ///< not literal without a number
};

/// One line. Its vectors are reused from line to line.
struct Block {
  int line = 0;         ///< of the file
  int text_line = 0;    ///< of the text: differs if calls of subprograms were expanded
  int called_from = 0;  ///< line of the call, in a copied block; 0: not copied
  Span span;            ///< without the line end
  Span line_end;        ///< empty for a last line without line end
  Span block_delete;    ///< '/' and the switch number that may follow it; empty without '/'
  bool percent = false;
  std::optional<CornerSize> corner;  ///< ",R2." or ",C1.", in the units of the program; NaN: an expression
  bool part_name = false;            ///< the line is the name of a program
  bool assigns = false;              ///< has '#1=', "R1="
  bool assigns_by_name = false;      ///< "_DEPTH=5", "MEAS=1": a variable or an unknown word
  Statement statement = Statement::none;
  bool statement_is_bare = false;  ///< nothing is behind its name
  Span statement_text;             ///< from its name to the comment
  bool has_own_mode = false;       ///< a word has a mode of its own
  Span flow_name;                  ///< of an O-word: "100" or "<name>"
  Span flow_keyword;               ///< of a line of flow: "sub", "GOTO"; empty for other lines
  /// Of a Sinumerik: ANG=, the direction of a line of which one coordinate is given.
  std::optional<Word> angle;
  std::vector<Word> words;
  std::vector<Assignment> assignments;  ///< of `assigns` and `assigns_by_name`
  std::vector<SpeedWord> speed_words;
  std::vector<Span> comments;  ///< the text inside the comment characters
};

inline std::string_view part(std::string_view text, Span span) {
  return text.substr(span.begin, span.end - span.begin);
}
/// The value of an integer word (T, N, H, P), without decimals. A very large value is clamped.
long count_of(const Word& word);

inline bool empty(Span span) {
  return span.begin == span.end;
}

/// Whether a line has words, a comment or a statement for the control.
inline bool has_content(const Block& block) {
  return !block.words.empty() || !block.speed_words.empty() || block.assigns ||
         block.statement != Statement::none || !empty(block.flow_keyword);
}

/// Whether the block is an O-number alone in its line.
inline bool is_program_number(const Block& block) {
  return block.words.size() == 1 && block.words[0].letter == 'O';
}

/// Whether an O-number begins a block without a motion.
bool begins_with_program_number(const Block& block);

/// Moves `block` to the line after `block.line_end`; false at the end of `text`. A default Block is before
/// the first line.
bool next_line(std::string_view text, Block& block);

/// Finds the words and comments of the line at `block.span`. Throws `InputError` for text that is not G-code.
void lex(std::string_view text, const std::string& file, const Dialect& dialect, Block& block);

/// Throws an `InputError` at byte `at` of `block`.
[[noreturn]] void refuse(const std::string& file, const Block& block, std::size_t at,
                         const std::string& message, ErrorKind kind = ErrorKind::program_text);

}  // namespace counterflex
