#pragma once
/// A machining program: its bytes, and the moves found in them with the spans of the words that hold
/// coordinates. This module knows text and nothing of machines. Coordinates are those of the program,
/// converted to mm.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/geometry/pose.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/program/rare.hpp"

namespace counterflex {

/// Bytes [begin, end) of a document.
struct Span {
  std::size_t begin = 0;
  std::size_t end = 0;
};

enum class LengthUnit : std::uint8_t { millimetres, inches };

/// What a length word without a point means: `unsaid` reads it in units, but a block that holds such a word
/// and must be rewritten is refused where the dialect knows both readings; `increments` are 0.001 mm or
/// 0.0001 inch.
enum class IntegerWords { unsaid, units, increments };

/// One word of a move that holds a length, as the text holds it.
struct AxisWord {
  Span number;       ///< the number's characters, without the letter
  int decimals = 0;  ///< digits after the point
};

/// An `AxisWord` or nothing, as `std::optional`, in half the room: every move has three of them, and an arc
/// four.
class PackedAxisWord {
 public:
  PackedAxisWord() = default;
  PackedAxisWord(std::nullopt_t) {}
  PackedAxisWord(const AxisWord& word)
      : begin_(word.number.begin),
        length_(static_cast<std::uint32_t>(word.number.end - word.number.begin)),
        decimals_(word.decimals) {}

  struct Pointer {
    AxisWord word;
    const AxisWord* operator->() const { return &word; }
  };

  bool has_value() const { return length_ != 0; }  ///< a number has a digit
  explicit operator bool() const { return has_value(); }
  AxisWord operator*() const { return {{begin_, begin_ + length_}, decimals_}; }
  Pointer operator->() const { return {**this}; }
  void reset() { length_ = 0; }

 private:
  std::size_t begin_ = 0;
  std::uint32_t length_ = 0;
  std::int32_t decimals_ = 0;
};

/// How a move goes: a feed move is a line unless it holds an arc.
enum class Motion : std::uint8_t { rapid, feed };

/// What F means: a length a minute (turns of the spindle are converted), or G93, moves a minute.
enum class FeedMode : std::uint8_t { length, inverse_time };

/// How a block of polar coordinates gives the end of its arc: CP IPA, CP PA of Klartext.
enum class PolarEnd : std::uint8_t { none, by_angle, in_direction };

/// The arc of a feed move under G2 or G3, in program coordinates, mm. Start and end are the move's.
struct ArcMove {
  int normal = 2;                       ///< axis that the plane's normal is: 2 G17, 1 G18, 0 G19
  bool clockwise = false;               ///< G2: seen against the normal
  Vector3 centre_mm = Vector3::Zero();  ///< at the height of the start
  int turns = 0;                        ///< full turns besides the way from start to end
  bool absolute_centre = false;         ///< G90.1: I J K are coordinates, else they count from the start
  bool flat = false;  ///< the block takes no word of the axis `normal` (C and CR of Klartext)
  PolarEnd polar = PolarEnd::none;
  std::array<PackedAxisWord, 3> centre_words;  ///< I, J, K where the block has them
  PackedAxisWord radius_word;                  ///< R or CR=: then there are no I J K
  double radius_mm = 0;                        ///< as written: negative for more than half a turn
};

/// Unit normal about which the arc goes counter-clockwise, program coordinates.
inline Vector3 normal_of(const ArcMove& arc) {
  return (arc.clockwise ? -1 : 1) * Vector3::Unit(arc.normal);
}

/// A hole: a move under G73, G76, G81 to G89. The move's X and Y words and end are those of the hole; its
/// end's Z is where the cycle leaves the tool. Coordinates as for the move.
struct CycleMove {
  double bottom_mm = 0;   ///< Z of the bottom and R of the retract plane that act here, sticky from earlier
  double retract_mm = 0;  ///< holes or programmed, as absolute coordinates
  PackedAxisWord bottom_word, retract_word;  ///< Z and R where the block has them
  bool may_insert_bottom = true;             ///< an absolute Z may be added to a block that omits it
  bool first = false;                        ///< programs the cycle: those that follow repeat it
  bool begins_series = false;  ///< the first hole since another motion: G98 comes back to where it begins
  double initial_mm = 0;  ///< Z where the series of this hole began; means something where its end is known
  bool returns_to_retract = false;  ///< G99: the cycle leaves the tool at `retract_mm`, else where it began
  int repeats = 1;                  ///< L or K
};

/// A drilling cycle of a Sinumerik, called in the block, or by every block with a position (MCALL). Its heights are
/// absolute and go along with the hole.
struct CalledCycle {
  std::string modal;  ///< MCALL with its call, without N and comment; empty: the block itself calls
  int line = 0;       ///< of the call or MCALL, in the file
  std::array<PackedAxisWord, 4> heights;  ///< RFP, RTP, DP, FDEP where they are given; spans in Program::text, else in `modal`
  std::array<double, 4> heights_mm{};
};

/// What a control takes off a line for the corners that it rounds or breaks (mm along the line). These parts stay at one
/// height: both sides of a corner lie in one plane.
struct CornerEnds {
  double begin_mm = 0, end_mm = 0;
};

/// How a move is corrected.
enum class Handling : std::uint8_t {
  own,    ///< by the correction of its own end
  held,   ///< it keeps the correction with which it is entered: a rigid shift of its absolute words
  group,  ///< by the one motion of its contour group under G41 or G42
};

/// Whether a position is known on all three axes.
inline bool all_known(const std::array<bool, 3>& known) {
  return known[0] && known[1] && known[2];
}

/// A move: a block that changes or repeats the position of the tool under G0 to G3 or a cycle, or that moves
/// it in a way that this reader does not follow: then all it says is `fixed` and what is unknown afterwards.
struct Move {
  Move() noexcept {}                    // a defaulted one would set every byte to zero first
  int line = 0;                         ///< of the file
  int text_line = 0;                    ///< of Program::text, where calls were expanded in it; 0: `line`
  int group = 0;                        ///< number of its contour group, from 1; 0: none
  std::array<bool, 3> stands{};         ///< of a block that is not followed: axes that only the program has
                                        ///< moved since the move before, though their place may be unknown
  std::size_t block_index = 0;          ///< counts the program's blocks with words, from 0
  Span block;                           ///< the whole line, without its line end
  std::array<PackedAxisWord, 3> words;  ///< X, Y, Z where the block has them
  Vector3 start_mm = Vector3::Zero();
  Vector3 end_mm = Vector3::Zero();
  Rare<ArcMove> arc;
  Rare<CycleMove> cycle;
  Rare<CalledCycle> called;          ///< then the word of Z is its first height
  Rare<CornerEnds> corners;          ///< of a move beside corners; infinite where a size is unknown
  Rare<Vector6> force;               ///< modal (FORCE ...) comment, (N, N m) on the tool, machine frame; none
                                     ///< after (FORCE OFF); a comment acts from the block that holds it
  double feed_mm_min = 0;            ///< modal F; 0 where none has been programmed
  double feed_per_min = 0;           ///< F of a G93 move: 1/min
  double spindle_rpm = 0;            ///< modal S
  std::optional<long> block_number;  ///< N
  std::uint32_t frame = 0;           ///< index into Program::frames
  std::int32_t tool = 0;             ///< T in the spindle, else H of G43; 0: none known
  std::uint32_t operation = 0;       ///< index into Program::operations
  Motion motion = Motion::rapid;
  LengthUnit unit = LengthUnit::millimetres;
  FeedMode feed_mode = FeedMode::length;
  Handling handling = Handling::own;
  std::array<bool, 3> known_start{};  ///< whether the position before the move is known, by axis
  std::array<bool, 3> known_end{};    ///< and after it
  std::array<bool, 3> ignored{};      ///< axes that nobody corrects: no word is inserted for them
  std::array<bool, 3> fixed{};  ///< axes that the block sets to a place of its own which no edit can shift
                                ///< (an expression, a subprogram): a correction that holds there must be zero
  bool relative = false;        ///< G91: words are differences from the start
  std::uint8_t incremental : 3 = 0;  ///< bit of an axis: its word alone is a difference from the start
  bool polar : 1 = false;            ///< LP, CP of Klartext: two of the words are one polar word
  bool takes_no_z : 1 = false;       ///< no word of Z may be inserted: beside a corner, in the holes of a Klartext cycle
  bool makes_hole : 1 = false;  ///< of Klartext and Sinumerik: a cycle that goes along with the tool is called at its end
  bool mills_at_end : 1 = false;  ///< a cycle mills about its end, and goes along with that point as a whole: what it cuts is
                                  ///< not corrected each on its own
  bool repeats_surface : 1 = false;  ///< its Z is the surface of a Klartext cycle, as an earlier hole has said it
  bool may_position : 1 = false;  ///< of a called cycle: a rapid to its place in X and Y may be inserted before it
  std::uint8_t angle_axis : 2 = 0;  ///< 1 X, 2 Y: its word is ANG=, the direction of the line; the other axis has one
  bool stays_whole : 1 = false;  ///< a word of the block acts at its begin or end: not even a line beside corners is divided
  bool block_delete : 1 = false;  ///< a '/' block: what it sets is unknown to the blocks after it
  bool exact_stop : 1 = false;  ///< the control stops at the end (G9, G61 of Fanuc, G61.1 of LinuxCNC)
  bool may_split : 1 =
      false;  ///< points may be inserted: a feed move, no exact stop, no word that acts at its end
  bool may_jump : 1 = false;  ///< a feed move may be inserted before it: start and feed are known, no exact stop
  bool may_insert_words : 1 = true;  ///< axis words may be inserted; not into a block with G43, G44 or G49
};
static_assert(sizeof(Move) <= 248, "programs have millions of moves");

/// Whether the block of an arc stays at the height of its start: neither has it a word of the axis across its
/// plane nor does it take one.
inline bool stays_flat(const Move& move) {
  return move.arc && move.arc->flat && !move.words[static_cast<std::size_t>(move.arc->normal)];
}

/// How much of a line stays flat beside a corner (mm).
inline double flat_part_mm(double taken_mm) {
  return taken_mm > 0 ? 1.02 * taken_mm + 0.02 : 0;
}

/// Whether the height of a line beside corners may change between their parts, by points that are inserted there.
inline bool changes_height_inside(const Move& move) {
  constexpr double most_flat = 0.9;  // of the line
  if (!move.corners || move.arc || move.stays_whole || move.exact_stop || !move.may_insert_words) return false;
  const double flat_mm = flat_part_mm(move.corners->begin_mm) + flat_part_mm(move.corners->end_mm);
  return move.handling != Handling::held && flat_mm < most_flat * (move.end_mm - move.start_mm).norm();
}

/// Whether a word of `axis` says the way from the move's start.
inline bool is_relative(const Move& move, std::size_t axis) {
  return move.relative || (move.incremental >> axis & 1) != 0;
}

/// Whether a word of the axis may be inserted into the block of `move`.
inline bool may_insert_word(const Move& move, std::size_t axis) {
  return move.may_insert_words && !(move.takes_no_z && axis == 2);
}

/// Whether each axis has a word in the block of `move` or may get one.
inline bool takes_all_words(const Move& move) {
  return move.may_insert_words && (move.words[2] || !move.takes_no_z || changes_height_inside(move));
}

/// A block that is not corrected, and why.
struct LeftAlone {
  int line = 0;
  std::string why;
  bool machine_position =
      false;          ///< the block moves axes to a place that the machine knows: no move of the program
  int text_line = 0;  ///< as for a move
};

/// The line of Program::text, in whose order moves and blocks left alone stand.
template <typename Placed>
int line_in_text(const Placed& placed) {
  return placed.text_line > 0 ? placed.text_line : placed.line;
}

/// A remark for the report.
struct Remark {
  int line = 0;
  std::string what;
};

/// How far a control is allowed to leave the path from a block on: G64 P Q.
struct PathTolerance {
  int line = 0;
  std::optional<double> path_mm;   ///< P; none: any distance
  std::optional<double> merge_mm;  ///< Q: moves that are this near to a line become one
};

/// Lines of a text in which calls were expanded, from `text_line` on: they are those of the file from `line`
/// on.
struct LineRun {
  int text_line = 1;
  int line = 1;
  int called_from = 0;  ///< line of the file that calls what these lines are copied from; 0: no copies
};

/// A call that was not expanded, or a loop, a condition or a jump that was not executed.
struct CallLeft {
  int text_line = 0;
  std::string why;
  bool is_flow = false;  ///< no call
};

/// What became of calls of subprograms, loops, conditions and jumps where they were to be expanded.
struct Expansion {
  std::vector<LineRun> lines;  ///< none: the text is the file's
  int file_lines = 0;
  std::size_t calls = 0;  ///< replaced, each repeat and each call in a copy too
  int first_call = 0;     ///< line of the file
  std::size_t executed = 0;  ///< loops, conditions and jumps, each pass
  int first_executed = 0;    ///< line of the file
  bool in_order = false;     ///< the text holds the blocks of the program itself in the order in which they run
  std::vector<CallLeft> calls_left;  ///< by lines
  std::vector<Span> unused;  ///< definitions in the text that nothing calls any more: nothing in them runs
};

/// The line of the file that line `text_line` of Program::text comes from.
int line_of_file(const Expansion& expansion, int text_line);

/// Coordinates in which moves are programmed: those of a work offset, shifted and turned about Z by plain numbers of the
/// program (G10, G52, G92, G68, TRANS, ROT).
struct ProgramFrame {
  std::string work_offset{};              ///< "G54", "G54.1 P3", ...; empty: none selected yet
  Vector3 origin_mm = Vector3::Zero();    ///< in the coordinates of the offset
  double turn_rad = 0;                    ///< about Z, counter-clockwise
  std::array<std::optional<double>, 3> set_mm{};  ///< by axis: the offset's place in machine coordinates, where the
                                                  ///< program has set it (G10 L2)

  bool operator==(const ProgramFrame&) const = default;
};

/// Whether the program itself sets the place of the frame's work offset (G10 L2).
inline bool is_set(const ProgramFrame& frame) {
  return frame.set_mm[0] || frame.set_mm[1] || frame.set_mm[2];
}

/// The place of `frame` in the coordinates of its work offset (mm).
Pose in_offset(const ProgramFrame& frame);

/// A program, or a window of one: then `text` holds some of its lines, `moves` and `left_alone` are those of
/// these lines, and all else is what has been found from the program's first line on.
struct Program {
  std::string file;
  std::string text;     ///< every byte of the input, with calls replaced where that was asked for
  std::string dialect;  ///< the one that was read, never "auto"
  IntegerWords integer_words = IntegerWords::unsaid;
  std::vector<Move> moves;
  std::optional<Move>
      before{};                 ///< of a window: the last move of the one before it, and the first one of the
  std::optional<Move> after{};  ///< next; the spans of both lie in other texts
  std::vector<ProgramFrame> frames{{}};        ///< in which moves are programmed; the first: no offset selected yet
  std::vector<std::string> operations{""};    ///< texts of comments that stand alone in their lines, of this
                                              ///< window; the first: the one that stood last before it
  std::vector<LeftAlone> left_alone;
  std::vector<Remark> remarks;
  std::vector<PathTolerance> path_tolerances;  ///< each different one once
  std::size_t block_count = 0;                 ///< lines with at least one word
  std::size_t evaluated = 0;                   ///< words that were variables or expressions and are their values
  Expansion expansion{};
};

/// The move before `moves[index]`, of this window or the one before it; null where there is none.
inline const Move* move_before(const Program& program, std::size_t index) {
  if (index > 0) return &program.moves[index - 1];
  return program.before ? &*program.before : nullptr;
}

}  // namespace counterflex
