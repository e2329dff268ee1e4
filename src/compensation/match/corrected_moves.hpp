#pragma once
/// The moves of a corrected program in order, read on as they are asked for.
#include <deque>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "counterflex/compensation/options.hpp"
#include "counterflex/program/kept_words.hpp"

namespace counterflex {

/// A line of a program that holds no move: it has to be the original's.
struct OtherLine {
  int line = 0;  ///< of the file
  std::string text;
  /// Without the numbers of targets that it gives moves in other lines: those are judged by their moves.
  /// Empty if it gives none.
  std::string without_targets{};
};

bool are_equal(const OtherLine& a, const OtherLine& b);

/// Where a move is among the lines without a move, from the program's beginning on.
struct PlaceAmongLines {
  std::size_t others = 0;  ///< lines without a move before it
  std::string acting{};    ///< `ActingWords` and `PositionWords` of the move
};

/// The lines without a move of a program that is read in windows, the header and guards aside, and an MCALL
/// of a Sinumerik if the next move is one of its holes: the hole compares it. Of statements of Klartext that
/// set the surface of a hole that is judged, and differ in that alone, the first one counts: the others are
/// judged by their holes. An inserted block is beside the block that it belongs to: both have the same number
/// of such lines before them.
class OtherLines {
 public:
  /// Takes in the next window; the places of its moves.
  std::vector<PlaceAmongLines> add(const Program& window);

  std::deque<OtherLine> lines{};  ///< that were not compared yet

  /// Whether no line of a guard may follow.
  bool has_passed_guard() const { return guard_ == Guard::behind; }

  /// The lines of a guard, each once.
  std::vector<OtherLine> take_guard() { return std::exchange(guard_lines_, {}); }

 private:
  struct WaitingLine {
    OtherLine line;
    bool calls = false;  // MCALL with a drilling cycle
  };

  enum class Guard { before, inside, behind };  ///< where the text is: one block, before the first cut

  void end_statement();
  void end_calls(bool at_hole);
  bool is_of_guard(const Program& window, std::size_t line_begin);

  std::vector<OtherLine> statement_{};       // that is being read
  std::vector<WaitingLine> waiting_{};       // for the next move, from an MCALL on
  bool sets_surface_ = false;                // it
  std::vector<std::string> last_surface_{};  // the last one that has
  ActingWords acting_{};
  Guard guard_ = Guard::before;
  std::vector<OtherLine> guard_lines_{};
  int lines_before_ = 0;   // of the text, before the window
  std::size_t count_ = 0;  // without a move
};

/// A move with the text that holds it.
struct CorrectedMove {
  const Program* program;
  const Move* move;
  std::size_t others;  ///< as in PlaceAmongLines
  std::string words;   ///< `kept_words`, and what acts besides
};

class CorrectedMoves {
 public:
  using ReadWindow = std::function<bool(Program&)>;  ///< reads the next window; false at the end

  explicit CorrectedMoves(ReadWindow read) : read_(std::move(read)) {}
  explicit CorrectedMoves(const Program& whole) { add(whole); }
  CorrectedMoves(const CorrectedMoves&) = delete;

  /// The move `index` places on, until more is read; null behind the last one.
  const CorrectedMove* at(std::size_t index);

  /// The first `count` moves, which `at` has found, until more is read.
  std::span<const CorrectedMove> first(std::size_t count) const {
    return std::span(moves_).subspan(first_, count);
  }

  /// Removes the first `count` moves.
  void drop(std::size_t count);

  /// Of what has been read.
  OtherLines& other_lines() { return other_lines_; }

 private:
  bool read_on();
  void add(const Program& window);

  ReadWindow read_;
  std::deque<Program> windows_;  // that hold moves from `first_` on
  std::vector<CorrectedMove> moves_;
  std::size_t first_ = 0;
  OtherLines other_lines_;
};

}  // namespace counterflex
