#pragma once
/// What of a block correction never changes.
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/program/guard.hpp"
#include "counterflex/program/program.hpp"

namespace counterflex {

/// The block without blanks and without the words of a move that are rewritten: N (of a split block the first
/// piece has it), axes, centre, radius, heights of a cycle, the turns of an arc, G0 to G3 (the move has
/// the motion), and F, if it is known, of a G93 move and of a feed move that gives angles. Of Klartext L, C
/// and the like, DR and polar words are left out only where the move has the arc or the end that they give.
///
/// Of a robot program: the statement without blanks, comment and the size of a zone, with its targets as they
/// are in the text, without the numbers that correction changes. The statement of an arc is that of a line,
/// with the auxiliary point behind a mark.
std::string kept_words(const Program& program, const Move& move);

/// The same of the part `within` of a robot program that declares targets of moves, whose numbers are
/// `numbers`, in the order of the text.
std::string declared_kept_words(const Program& program, Span within, const std::vector<Span>& numbers);

/// The same of a line without moves; `rest` is the line without `Program::counts`. Counts of positions in a
/// job of Yaskawa become their surplus over the positions in the text. Klartext has no block numbers and
/// nothing of a CC.
std::string line_kept_words(const Program& program, std::string_view line, std::string rest);

/// What earlier blocks give to moves that are not followed: the CC of an arc or of polar coordinates in
/// Klartext, the G2 or G3 of an arc in G-code. It takes in the lines and moves of a program in the order of
/// the text.
class ActingWords {
 public:
  /// A line without a move.
  void read(const Program& program, Span line);

  /// The words that act in the next move. Empty for a move that is followed: its path is judged.
  std::string of(const Program& program, const Move& move);

 private:
  std::string words_;
};

// The time of a block that only turns the tool. LinuxCNC reads F along X, Y and Z as soon as one of them
// moves, and in degrees per minute where only A, B and C move. Correction moves X, Y and Z there by little.

/// Shorter turns (deg) may take another time.
inline constexpr double short_turn_deg = 0.02;

/// By how much A, B and C turn (deg), as F counts it.
double turned_deg(const OrientationNumbers& start, const OrientationNumbers& end);

/// The same of a move; 0 for moves without such angles.
double turned_deg(const Move& move);

/// Whether the feed move turns A, B and C by more than `short_turn_deg`, and does not move X, Y and Z.
bool only_turns(const Move& move);

class JbiPositionWords;

/// The positions of the statements of a Yaskawa job. Insertion changes their numbers: their values and the
/// pseudo instructions above them (RCONF, TOOL, USER, POSTYPE) take the place of these. Programs of other
/// languages have none.
class PositionWords {
 public:
  /// `program` must outlive them.
  explicit PositionWords(const Program& program);
  ~PositionWords();

  /// Of a statement. Without the values of the target of a move that is followed, and of the point inside of
  /// its circle: these are judged.
  std::string of(const Move& move) const;
  std::string of(Span line) const;

 private:
  std::unique_ptr<const JbiPositionWords> job_;  // null: another language
};

/// The line at byte `begin` of the program's text without its number, if it is one of a guard, with its right
/// mark.
std::optional<std::string> line_of_guard(const Program& program, std::size_t begin);

/// All such lines of `guard`, as they are written.
std::vector<std::string> lines_of_guard(const std::string& dialect, const Guard& guard);

/// Whether the kept words of two moves are of one statement. A line may be a chord of an arc.
bool are_alike(const std::string& a, const std::string& b);

/// Whether kept words are only those that an inserted piece may have: F, in Klartext also FMAX, FAUTO, FU, FZ
/// and FT. Comments do not count.
bool is_plain(const std::string& words);

/// The word of the feed in kept words, with its value as it is in the text; empty without one.
std::string feed_word(const std::string& words);

/// Whether a block that is split is itself the first of its pieces, as its words act at its beginning: it has
/// a label, other words than those of the move and F, or sets the force. `words`: its kept words. Others are
/// the last piece.
bool is_first_piece(const Move& move, const std::string& words);

}  // namespace counterflex
