#pragma once
/// A machining program: its bytes, and the moves found in them with the spans of the words that hold
/// coordinates. This module knows text and nothing of machines. Coordinates are those of the program,
/// converted to mm.
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/geometry/types.hpp"

namespace counterflex {

/// Bytes [begin, end) of a document.
struct Span {
  std::size_t begin = 0;
  std::size_t end = 0;
};

enum class LengthUnit { millimetres, inches };

/// What a length word without a point means: `unsaid` reads it in units, but a block that holds such a word
/// and must be rewritten is refused where the dialect knows both readings; `increments` are 0.001 mm or
/// 0.0001 inch.
enum class IntegerWords { unsaid, units, increments };

/// One axis word of a move as the text holds it.
struct AxisWord {
  Span number;       ///< the number's characters, without the letter
  int decimals = 0;  ///< digits after the point
};

enum class Motion { rapid, feed };

/// Whether a position is known on all three axes.
inline bool all_known(const std::array<bool, 3>& known) {
  return known[0] && known[1] && known[2];
}

/// A move: a block that changes or repeats the position of the tool under G0 or G1.
struct Move {
  int line = 0;
  std::size_t block_index = 0;  ///< counts the program's blocks with words, from 0
  Span block;                   ///< the whole line, without its line end
  Motion motion = Motion::rapid;
  LengthUnit unit = LengthUnit::millimetres;
  std::array<std::optional<AxisWord>, 3> words;  ///< X, Y, Z where the block has them
  std::array<bool, 3> known_start{};             ///< whether the position before the move is known, by axis
  std::array<bool, 3> known_end{};               ///< and after it
  std::array<bool, 3> ignored{};  ///< axes that nobody corrects: no word is inserted for them
  Vector3 start_mm = Vector3::Zero();
  Vector3 end_mm = Vector3::Zero();
  double feed_mm_min = 0;            ///< modal F; 0 where none has been programmed
  double spindle_rpm = 0;            ///< modal S
  std::optional<long> block_number;  ///< N
  std::string work_offset;           ///< "G54", ... as selected here; empty before any
  std::optional<Vector6> force;      ///< modal (FORCE ...) comment, (N, N m) on the tool, machine frame; zero
                                     ///< after (FORCE OFF); a comment acts from the block that holds it
  bool block_delete = false;         ///< a '/' block: what it sets is unknown to the blocks after it
  bool exact_stop = false;           ///< the control stops at the end (G9, G61 of Fanuc, G61.1 of LinuxCNC)
  bool may_split =
      false;  ///< points may be inserted: a feed move, no exact stop, no word that acts at its end
  bool may_jump = false;  ///< a feed move may be inserted before it: start and feed are known, no exact stop
  bool may_insert_words = true;  ///< axis words may be inserted; not into a block with G43, G44 or G49
};

/// A block that is not corrected, and why.
struct LeftAlone {
  int line = 0;
  std::string why;
};

/// A remark for the report.
struct Remark {
  int line = 0;
  std::string what;
};

struct Program {
  std::string file;
  std::string text;     ///< every byte of the input
  std::string dialect;  ///< the one that was read, never "auto"
  IntegerWords integer_words = IntegerWords::unsaid;
  std::vector<Move> moves;
  std::vector<LeftAlone> left_alone;
  std::vector<Remark> remarks;
  std::size_t block_count = 0;  ///< lines with at least one word
};

}  // namespace counterflex
