#pragma once
/// Writes a corrected program: the bytes of the input with changed coordinate words and inserted moves. All
/// other bytes stay.
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/geometry/curve.hpp"
#include "counterflex/program/guard.hpp"
#include "counterflex/program/program.hpp"

namespace counterflex {

// Block numbers (N words) that a program uses, and numbers that are free for inserted pieces.

/// All numbers behind an N in the text of a program, also in comments and jumps. No inserted block may get
/// one of them.
class BlockNumbers {
 public:
  /// Adds the next whole lines of the program.
  void add(std::string_view lines);

  /// Call it once, after the last line.
  void finish();

  /// Whether the program uses none of the `count` numbers that follow `number`. False for a number that
  /// begins several blocks: their pieces would share numbers.
  bool has_room_after(long number, std::size_t count) const;

 private:
  std::vector<std::uint32_t> used_;      ///< sorted, each once
  std::vector<std::uint32_t> repeated_;  ///< sorted; first the numbers at the beginning of each line
};

struct WriteOptions {
  /// Digits after the decimal point of changed and inserted words; -1: as in the word, at least the dialect's
  /// resolution.
  int decimals = -1;
  std::vector<std::string> header;  ///< texts of the header's comments, without comment characters
  /// Numbers of the program: the pieces of a block Nn after the first become Nn+1, Nn+2 ... if these are
  /// free. Null: they have no N.
  const BlockNumbers* number_pieces = nullptr;
  std::size_t most_points = 0;   ///< of a robot program; 0: any number
  std::optional<Guard> guard{};  ///< checks before the first cut (`first_cut`)
};

/// A point on the path of a move. The tool reaches it on a line, or on an arc about a centre in the move's
/// own plane and direction.
struct Via {
  Vector3 end_mm = Vector3::Zero();
  std::optional<Vector3> centre_mm{};
  BoxedOptional<OrientationNumbers> orientation{};  ///< of a move that has one, in its form
};

/// New end of one move, and moves inserted before it, in program coordinates, mm.
struct MoveEdit {
  std::size_t move = 0;  ///< index into Program::moves
  /// Inserts a feed move to this point first, also before a rapid; needs `may_jump`.
  std::optional<Via> jump{};
  /// Points on the path, same motion and feed; need `may_split`; under G93 they share the block's time by
  /// length.
  std::vector<Via> inserted{};
  Vector3 end_mm = Vector3::Zero();
  /// Of an arc's last piece; empty for an arc: it is written as chords through the inserted points, under G1.
  std::optional<Vector3> centre_mm{};
  BoxedOptional<OrientationNumbers> orientation{};  ///< at the end, of a move that has one, in its form
  std::optional<double> bottom_mm{}, retract_mm{};  ///< of a cycle: its Z and R as absolute coordinates
};

/// Digits after the decimal point at the end of `move`, by axis, and in points inserted before it.
struct Decimals {
  std::array<int, 3> end;
  int inserted;
};
Decimals decimals_of(const Move& move, const WriteOptions& options);

/// A point in program coordinates (mm), rounded to `decimals` digits in the move's unit.
Vector3 as_written_mm(const Vector3& p_mm, LengthUnit unit, const std::array<int, 3>& decimals);

/// Position of the tool in the written text, in program coordinates (mm). Empty for an axis whose position is
/// unknown.
struct TextPosition : std::array<std::optional<double>, 3> {
  std::optional<double> cycle_initial_mm{};         ///< Z at which the active series of cycles began
  BoxedOptional<OrientationNumbers> orientation{};  ///< the numbers in the text, where they are known

  void set(const Vector3& p_mm) {
    for (std::size_t axis = 0; axis < 3; ++axis) (*this)[axis] = p_mm[static_cast<Eigen::Index>(axis)];
  }
  /// Where all axes are known.
  std::optional<Vector3> place_mm() const {
    if (!(*this)[0] || !(*this)[1] || !(*this)[2]) return std::nullopt;
    return Vector3(*(*this)[0], *(*this)[1], *(*this)[2]);
  }
};

/// The position in the written text after `move`, whose end is edited to `end_mm`. `before` is the position
/// before the move, or after the last inserted point (`as_written`). A word is unchanged if the new value
/// rounds to it. A missing word is inserted only if the position differs by more than half a digit and the
/// block may get the word. Under G91 a word is the difference from `before`. If a cycle leaves the tool at
/// the plane of its R word, Z of `end_mm` is that plane. `rewrite` follows the same rules for each word.
TextPosition text_position_after(const Move& move, const TextPosition& before, const Vector3& end_mm,
                                 const WriteOptions& options);

/// The position in the written text after `last`, in the coordinates of `next`. A change of tool length
/// shifts the coordinates while the machine does not move.
TextPosition text_position_between(const Move& last, const Move& next, const TextPosition& position);

/// The curve that a control reads for a piece of a move from `before` to `via`, with words rounded to their
/// digits: start, end, and for an arc the centre that I J K or R give. `is_end`: the piece ends at the move's
/// own end, whose words may have other digits, and makes the arc's full turns. If rounding makes a piece of
/// an arc a point or a full circle, the result has no arc: the piece is not written, or at the move's end it
/// is written as G1. All axes of `before` must be known. If the block itself is the first piece of its move
/// (it has other words), its axis words may have one digit more.
Curve as_written(const Move& move, const TextPosition& before, const Via& via, bool is_end,
                 const WriteOptions& options);

/// The share of `sweep` (rad) at which the auxiliary point of an arc is written that takes the place of the
/// arc of `move`, or of a part of it: that of the original for the same sweep, else the middle.
double share_of_point(const Move& move, double sweep);

/// Points of a robot program, from its first window on: targets, or what the control counts (SizeLimit).
struct PointCount {
  std::size_t before = 0;     ///< in the original
  std::size_t after = 0;      ///< in the written program
  int first_line_beyond = 0;  ///< line of the original with the first point above `most_points`; 0: none
};

struct Rewritten {
  std::string text;
  std::size_t changed_words = 0;
  std::size_t inserted_words = 0;  ///< in blocks of the input
  std::size_t inserted_blocks = 0;
  /// Number of blocks inserted for each edit: its jump and its points.
  std::vector<std::size_t> blocks_of_edit;
  /// Pieces without N, because `WriteOptions::number_pieces` has no free numbers.
  std::size_t unnumbered_pieces = 0;
  int first_unnumbered_line = 0;  ///< line of the first block with such pieces; 0: there are no such pieces
  PointCount points;
};

class ProgramWriter;

/// Writes a program window by window (ProgramReader).
class Rewriter {
 public:
  explicit Rewriter(const WriteOptions& options);
  ~Rewriter();
  Rewriter(Rewriter&&) noexcept;

  /// The text of the next window with `edits` of its moves, as written by `rewrite`.
  Rewritten write(const Program& window, const std::vector<MoveEdit>& edits);

 private:
  WriteOptions options_;
  std::unique_ptr<ProgramWriter> writer_;  ///< null before the first window
};

/// Applies `edits`, sorted by move, at most one per move. The first piece of a block gets its N. A move
/// without an edit keeps its text; but if a block relies on the modal motion and an edit before it has
/// changed that motion, the block gets a motion word. A fixed axis is not changed, and neither is an axis
/// without a word whose position is unknown at the move's end. Inserted points that round to the point before
/// them give no block. Throws `InputError` (ErrorKind::program_text) for an integer word in a block that must
/// be rewritten (see IntegerWords), and for a block that would be longer than the control reads.
Rewritten rewrite(const Program& program, const std::vector<MoveEdit>& edits, const WriteOptions& options);

}  // namespace counterflex
