#pragma once
/// Writes a corrected program: the input's bytes with changed coordinate words and inserted moves, nothing else.
#include <string>
#include <vector>

#include "counterflex/program/program.hpp"

namespace counterflex {

struct WriteOptions {
  int decimals = -1;                ///< digits after the point of changed and inserted words; -1: the word's own, at least the dialect's resolution
  std::vector<std::string> header;  ///< texts of the header's comments, without comment characters
};

/// New end of one move, and moves inserted before it (same motion and feed), in program coordinates, mm.
struct MoveEdit {
  std::size_t move = 0;  ///< index into Program::moves
  std::vector<Vector3> inserted_mm;
  Vector3 end_mm = Vector3::Zero();
};

/// Digits after the point with which the end of `move` is written, by axis, and those of points inserted before it.
struct Decimals {
  std::array<int, 3> end;
  int inserted;
};
Decimals decimals_of(const Move& move, const WriteOptions& options);

/// A point in program coordinates (mm) as it is read back from text with `decimals` digits in the move's unit.
Vector3 as_written_mm(const Vector3& p_mm, LengthUnit unit, const std::array<int, 3>& decimals);

struct Rewritten {
  std::string text;
  std::size_t changed_words = 0;
  std::size_t inserted_words = 0;
  std::size_t inserted_blocks = 0;
};

/// Applies `edits`, in the order of moves, at most one a move. A move without an edit keeps its text. A word whose new
/// value rounds to its original stays as it is; an axis word is inserted only where the position that the emitted text
/// holds otherwise differs.
Rewritten rewrite(const Program& program, const std::vector<MoveEdit>& edits, const WriteOptions& options);

}  // namespace counterflex
