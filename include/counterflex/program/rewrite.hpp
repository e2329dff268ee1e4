#pragma once
/// Writes a corrected program: the input's bytes with changed coordinate words and inserted moves, nothing
/// else.
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "counterflex/geometry/curve.hpp"
#include "counterflex/program/block_numbers.hpp"
#include "counterflex/program/program.hpp"

namespace counterflex {

struct WriteOptions {
  int decimals = -1;  ///< digits after the point of changed and inserted words; -1: the word's own, at least
                      ///< the dialect's resolution
  std::vector<std::string> header;  ///< texts of the header's comments, without comment characters
  const BlockNumbers* number_pieces = nullptr;  ///< of the program: the pieces of a block Nn but the first
                                                ///< become Nn+1, Nn+2 ... where these are free; null: they
                                                ///< have no N
};

/// A point on the way of a move, and how it is come to: straight, or about a centre in the move's own plane
/// and sense.
struct Via {
  Vector3 end_mm = Vector3::Zero();
  std::optional<Vector3> centre_mm{};
};

/// New end of one move, and moves inserted before it, in program coordinates, mm.
struct MoveEdit {
  std::size_t move = 0;  ///< index into Program::moves
  std::optional<Vector3>
      jump_mm{};  ///< a feed move to this point goes first, also before a rapid; needs `may_jump`
  std::vector<Via> inserted{};  ///< points on the way, same motion and feed; need `may_split`; G93 shares the
                                ///< block's time among them by length
  Vector3 end_mm = Vector3::Zero();
  std::optional<Vector3> centre_mm{};  ///< of an arc's last piece; none where the move is an arc: it is
                                       ///< written as chords through the inserted points, under G1
  std::optional<double> bottom_mm{}, retract_mm{};  ///< of a cycle: its Z and R as absolute coordinates
};

/// Digits after the point with which the end of `move` is written, by axis, and those of points inserted
/// before it.
struct Decimals {
  std::array<int, 3> end;
  int inserted;
};
Decimals decimals_of(const Move& move, const WriteOptions& options);

/// A point in program coordinates (mm) as it is read back from text with `decimals` digits in the move's
/// unit.
Vector3 as_written_mm(const Vector3& p_mm, LengthUnit unit, const std::array<int, 3>& decimals);

/// Where the emitted text holds the tool, in program coordinates (mm); nothing for an axis that is unknown.
struct HeldPosition : std::array<std::optional<double>, 3> {
  std::optional<double> cycle_initial_mm{};  ///< Z where the series of cycles that acts has begun
};

/// The position that the emitted text holds after `move`, given the one before it, when its end is edited to
/// `end_mm`: a word that is within half its last digit of its original stays, a word that is absent is
/// inserted only where the held position is further away than that, and where it may be; under G91 a word
/// says the way from the held position. `before` is what the last inserted point leaves (`as_written`). Of a
/// cycle that leaves the tool at the plane that its R says, the Z of `end_mm` is that plane as it is edited.
/// `rewrite` follows exactly this, word by word.
HeldPosition held_after(const Move& move, const HeldPosition& before, const Vector3& end_mm,
                        const WriteOptions& options);

/// The position that the text holds after `last`, in the coordinates of the move that follows it: a change of
/// the tool's length moves the coordinates while the machine stands still.
HeldPosition held_between(const Move& last, const Move& next, const HeldPosition& held);

/// What a control reads of a piece of a move that is written to go from `before` to `via`, in words rounded
/// to their digits: start, end, and for an arc the centre that I J K or R then give. `is_end`: the piece ends
/// at the move's own end, whose words may have digits of their own, and makes the arc's full turns. A piece
/// of an arc that the digits make a point, or would turn into a full circle, comes back without an arc: it is
/// not written, or at the move's end as G1. Needs all of `before`. In a block that is itself the first piece
/// of its move (it holds other words) axis words may keep a digit more.
Curve as_written(const Move& move, const HeldPosition& before, const Via& via, bool is_end,
                 const WriteOptions& options);

struct Rewritten {
  std::string text;
  std::size_t changed_words = 0;
  std::size_t inserted_words = 0;  ///< in blocks of the input
  std::size_t inserted_blocks = 0;
  std::vector<std::size_t> blocks_of_edit;  ///< blocks inserted for each edit: its jump and its points
  std::size_t unnumbered_pieces = 0;        ///< for which `WriteOptions::number_pieces` had no room
  int first_unnumbered_line = 0;            ///< line of the first block with such pieces; 0: none
};

class ProgramWriter;

/// Writes a program window by window (ProgramReader).
class Rewriter {
 public:
  explicit Rewriter(const WriteOptions& options);
  ~Rewriter();
  Rewriter(Rewriter&&) noexcept;

  /// The text of the next window with `edits` of its moves, as `rewrite` has it.
  Rewritten write(const Program& window, const std::vector<MoveEdit>& edits);

 private:
  WriteOptions options_;
  std::unique_ptr<ProgramWriter> writer_;  ///< none before the first window
};

/// Applies `edits`, in the order of moves, at most one a move. The N of a block is that of its first piece. A
/// move without an edit keeps its text, but a block that relies on the modal motion says it behind an edit
/// that left another; an axis that is unknown at a move's end and has no word there is left alone, and so is
/// a fixed one. Inserted points that the resolution cannot tell from the one before give no block. Throws
/// `InputError` (Exit::program_text) for an integer word in a block that must be rewritten (see IntegerWords)
/// and for a block that would be longer than the control reads.
Rewritten rewrite(const Program& program, const std::vector<MoveEdit>& edits, const WriteOptions& options);

}  // namespace counterflex
