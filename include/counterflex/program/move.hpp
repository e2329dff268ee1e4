#pragma once
/// A move of a machining program, with the spans of the words that hold its coordinates. Coordinates are
/// program coordinates in mm.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "counterflex/geometry/pose.hpp"
#include "counterflex/geometry/turn.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/program/arc_turn.hpp"
#include "counterflex/program/boxed_optional.hpp"

namespace counterflex {

/// Bytes [begin, end) of a document.
struct Span {
  std::size_t begin = 0;
  std::size_t end = 0;
};

enum class LengthUnit : std::uint8_t { millimetres, inches, metres };

/// Length of a unit in mm.
constexpr double mm_per(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::millimetres:
      return 1;
    case LengthUnit::inches:
      return 25.4;
    case LengthUnit::metres:
      return 1000;
  }
  return 1;
}

/// A length word of a move, as it is in the text.
struct AxisWord {
  Span number;       ///< characters of the number, without the letter
  int decimals = 0;  ///< digits after the decimal point
};

/// An optional `AxisWord` of half the size of `std::optional<AxisWord>`: each move has three of them, each
/// arc four.
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

  bool has_value() const { return length_ != 0; }  ///< a number has at least one digit
  explicit operator bool() const { return has_value(); }
  AxisWord operator*() const { return {{begin_, begin_ + length_}, decimals_}; }
  Pointer operator->() const { return {**this}; }
  void reset() { length_ = 0; }

 private:
  std::size_t begin_ = 0;
  std::uint32_t length_ = 0;
  std::int32_t decimals_ = 0;
};

/// Kind of motion. A feed move is a line unless it has an arc.
enum class Motion : std::uint8_t { rapid, feed };

/// Meaning of F: length per minute (feed per turn is converted), or moves per minute (G93).
enum class FeedMode : std::uint8_t { length, inverse_time };

/// How a block in polar coordinates gives the end of its arc: CP IPA, CP PA of Klartext.
enum class PolarEnd : std::uint8_t { none, by_angle, in_direction };

/// The auxiliary point of an arc that a robot language gives by three points: its end and a point before it.
struct ArcPoint {
  Vector3 p_mm = Vector3::Zero();
  Vector3 normal = Vector3::UnitZ();  ///< of the plane of the points; the arc is counter-clockwise about it
  double share = 0.5;                 ///< of the sweep, from the start of the arc to this point
  /// What an arc in place of this one, or of a piece of it, must keep to be read as an arc; empty: nothing.
  std::optional<ArcTurnLimits> turn_limits{};
};

/// The arc of a feed move under G2 or G3, in program coordinates (mm), or of CIRC and its like. It begins and
/// ends where the move does.
struct ArcMove {
  int normal = 2;                       ///< axis normal to the plane: 2 G17, 1 G18, 0 G19
  bool clockwise = false;               ///< G2: clockwise when viewed against the normal
  Vector3 centre_mm = Vector3::Zero();  ///< at the height of the start
  int turns = 0;                        ///< full turns in addition to the sweep from start to end
  bool absolute_centre = false;         ///< G90.1: I J K are coordinates; otherwise they count from the start
  bool flat = false;  ///< the block must not have a word of the axis `normal` (C and CR of Klartext)
  PolarEnd polar = PolarEnd::none;
  std::array<PackedAxisWord, 3> centre_words;  ///< I, J, K of the block
  PackedAxisWord radius_word;                  ///< R or CR=; such an arc has no I J K
  double radius_mm = 0;                        ///< as written: negative for more than half a turn
  /// If set, `centre_words` are X, Y, Z of this point, `normal` is the axis next to its plane's normal, and
  /// the arc has no radius and no further turns.
  std::optional<ArcPoint> through{};
};

/// Unit normal about which the arc turns counter-clockwise, program coordinates.
inline Vector3 normal_of(const ArcMove& arc) {
  if (arc.through) return arc.through->normal;
  return (arc.clockwise ? -1 : 1) * Vector3::Unit(arc.normal);
}

/// A hole: a move under G73, G76, G81 to G89. X and Y of the move's words and of its end are those of the
/// hole. Z of its end is the height at which the cycle leaves the tool. Coordinates as for the move.
struct CycleMove {
  double bottom_mm = 0;   ///< absolute Z of the bottom; modal: from this block or an earlier hole
  double retract_mm = 0;  ///< absolute Z of the retract plane (R); modal, too
  PackedAxisWord bottom_word, retract_word;  ///< Z and R of the block
  bool may_insert_bottom = true;             ///< an absolute Z may be inserted into a block without one
  bool first = false;                        ///< the block programs the cycle; later holes repeat it
  /// First hole after another motion: G98 returns to the height at which it begins.
  bool begins_series = false;
  double initial_mm = 0;  ///< Z at which the series of this hole began; valid only if the end is known
  /// G99: the cycle leaves the tool at `retract_mm`; otherwise where the series began.
  bool returns_to_retract = false;
  int repeats = 1;  ///< L, or K of Fanuc
};

/// A drilling cycle of a Sinumerik, called in the block or by every block with a position (MCALL), or of
/// Klartext, whose heights are not words of a call. The heights are absolute and shift with the hole.
struct CalledCycle {
  std::string modal;  ///< MCALL with its call, without N and comment; empty: the block itself calls the cycle
  int line = 0;       ///< line of the call or of MCALL, in the file
  /// RFP, RTP, DP, FDEP; spans in `modal`, or in Program::text if `modal` is empty.
  std::array<PackedAxisWord, 4> heights;
  /// DP without a word is given by DPR, or NaN: the depth is not known.
  std::array<double, 4> heights_mm{};
};

/// How the size of a corner is given.
enum class CornerKind : std::uint8_t {
  round,    ///< by its radius
  side,     ///< a chamfer by the length removed from both sides
  chamfer,  ///< a chamfer by its own length
};

/// A corner that a control rounds or chamfers.
struct CornerSize {
  double mm = 0;  ///< NaN: not a plain number
  CornerKind kind = CornerKind::round;
};

/// Length that a corner removes from each of two lines whose directions differ by `turn` (rad), in the unit
/// of `size`.
double taken_by_corner(CornerKind kind, double size, double turn);

/// Length (mm) by which a control shortens a line for rounded or chamfered corners at its ends. These parts
/// of a line stay at one height, because both sides of a corner lie in one plane.
struct CornerEnds {
  double begin_mm = 0, end_mm = 0;
  CornerSize end_size{};  ///< of the corner at its end, between lines and arcs; valid only if `end_mm` > 0
};

/// What a target states of the turns of rotary axes, beside its pose. A corrected target keeps it.
enum class StatedTurns : std::uint8_t {
  none,
  signs,       ///< whether each rotary axis is negative: T of KUKA
  quadrants,   ///< the quarter turns of axes 1, 4 and 6: confdata of ABB
  half_turns,  ///< how often axes 1, 4 and 6 are beyond +-180 deg: CONFIG of FANUC, RCONF of Yaskawa
};

/// The tool's orientation along a move of a six-axis machine, in program coordinates. The numbers are as
/// programmed; those of a start are those at the end of the move before.
struct MoveOrientation {
  OrientationForm form = OrientationForm::fixed_axes;
  bool by_angles = false;  ///< the control interpolates the angles; else it turns about one axis
  StatedTurns stated_turns = StatedTurns::none;  ///< by the target
  SpindleAxis spindle_axis = SpindleAxis::z;     ///< of the tool frame that the numbers turn
  OrientationNumbers start{}, end{};
  std::array<PackedAxisWord, 4> words;  ///< of the block, by number
  /// Turn about the spindle axis that is wanted beside the numbers, at the start and at the end (rad): see
  /// `best_spins`. The text does not have it.
  double start_spin = 0, end_spin = 0;
};

/// How the control's tool frame should turn along the move.
Turn written_turn_of(const MoveOrientation& orientation);

/// How the tool frame with z from the tip to the spindle should turn along the move.
Turn turn_of(const MoveOrientation& orientation);

/// The numbers of the wanted orientation at fraction `u` of the move.
OrientationNumbers numbers_at(const MoveOrientation& orientation, double u);

/// The zone at a target of a robot, within which the control rounds the path: of a statement whose zone
/// corrections make smaller beside inserted targets.
struct TargetZone {
  Span words;  ///< "z10", or the number of r= and CR=
  double length_mm = 0;
  double least_mm = 0;            ///< smaller zones cannot be written
  bool must_not_overlap = false;  ///< the control skips a move if the zones at its ends overlap
};

/// How a move is corrected.
enum class Handling : std::uint8_t {
  own,    ///< by the correction at its own end
  held,   ///< it keeps the correction at its start: its absolute words are shifted rigidly
  group,  ///< by the common shift of its contour group under G41 or G42
};

/// Side of a contour in the plane X Y on which the cutter goes: G41 and RL, G42 and RR.
enum class CutterSide : std::uint8_t { none, left, right };

/// Whether it is so on one of three axes, at least.
inline bool any_axis(const std::array<bool, 3>& axes) {
  return axes[0] || axes[1] || axes[2];
}

/// Whether the position is known on all three axes.
inline bool all_known(const std::array<bool, 3>& known) {
  return known[0] && known[1] && known[2];
}

/// A move: a block that changes or repeats the position of the tool under G0 to G3 or a cycle, or that moves
/// the tool in a way that this reader does not follow. Of a move that is not followed only `fixed` and the
/// unknown axes are set.
struct Move {
  Move() noexcept {}  // a defaulted constructor would set every byte to zero first
  int line = 0;       ///< line of the file
  int text_line = 0;  ///< line of Program::text, if calls were expanded in it; 0: `line`
  int group = 0;      ///< number of its contour group, from 1; 0: it belongs to no group
  /// For a block that is not followed: axes that the machine has not moved by itself since the move before,
  /// though their position may be unknown.
  std::array<bool, 3> moved_only_by_program{};
  std::size_t block_index = 0;          ///< index among the program's blocks with words, from 0
  Span block;                           ///< the whole line without its line end
  std::array<PackedAxisWord, 3> words;  ///< X, Y, Z of the block
  Vector3 start_mm = Vector3::Zero();
  Vector3 end_mm = Vector3::Zero();
  BoxedOptional<ArcMove> arc;
  BoxedOptional<CycleMove> cycle;
  BoxedOptional<CalledCycle> called;  ///< with words: the word of Z is its first height
  BoxedOptional<CornerEnds> corners;  ///< corners at its ends; infinite if a size is unknown
  /// Of a program that turns the tool. Its position counts as known only where its orientation is.
  BoxedOptional<MoveOrientation> orientation;
  BoxedOptional<TargetZone> zone;  ///< of a robot's target that is passed, if the size of its zone is known
  /// Of the modal comment (FORCE ...): (N, N m) on the tool, machine frame; empty after (FORCE OFF). A
  /// comment applies from its own block on.
  BoxedOptional<Vector6> force;
  double feed_mm_min = 0;            ///< modal F; 0 before the first F
  double feed_per_min = 0;           ///< F of a G93 move: 1/min
  double spindle_rpm = 0;            ///< modal S
  std::optional<long> block_number;  ///< N
  std::uint32_t frame = 0;           ///< index into Program::frames
  std::int32_t tool = 0;             ///< T in the spindle, else H of G43; 0: unknown
  std::uint32_t operation = 0;       ///< index into Program::operations
  Motion motion = Motion::rapid;
  LengthUnit unit = LengthUnit::millimetres;
  FeedMode feed_mode = FeedMode::length;
  Handling handling = Handling::own;
  std::array<bool, 3> known_start{};  ///< whether the position before the move is known, by axis
  std::array<bool, 3> known_end{};    ///< whether the position after the move is known, by axis
  std::array<bool, 3> ignored{};      ///< axes that are not corrected: no word is inserted for them
  /// Axes that the block moves to a position that no edit can shift (an expression, a subprogram): the
  /// correction at that place must be zero.
  std::array<bool, 3> fixed{};
  bool relative : 1 = false;  ///< G91: words are differences from the start
  /// Of a block with `fixed` axes: where its words put the tool, at `end_mm`, it calls a cycle, a macro or a
  /// program that is not followed. This place is known on all axes.
  bool calls_at_end : 1 = false;
  std::uint8_t : 0;
  std::uint8_t incremental : 3 = 0;  ///< bit of an axis: only its word is a difference from the start
  bool polar : 1 = false;       ///< LP, CP of Klartext: two coordinates come from one pair of polar words
  bool takes_no_z : 1 = false;  ///< no Z word may be inserted: beside a corner, in holes of a Klartext cycle
  /// Klartext and Sinumerik: a cycle that moves with the tool is called at its end.
  bool makes_hole : 1 = false;
  /// A cycle mills around its end and shifts with it as a whole; its own motions are not corrected.
  bool mills_at_end : 1 = false;
  bool repeats_surface : 1 = false;  ///< its Z is the surface of a Klartext cycle, given by an earlier hole
  bool may_position : 1 = false;     ///< of a called cycle: a rapid to its X and Y may be inserted before it
  /// 1 X, 2 Y: its word is ANG=, the direction of the line; the other axis has a word. 0: no ANG=.
  std::uint8_t angle_axis : 2 = 0;
  /// A word of the block acts at its start or end: a line between corners is not split, either.
  bool stays_whole : 1 = false;
  bool block_delete : 1 = false;  ///< a '/' block: states that it sets are unknown afterwards
  bool sets_force : 1 = false;    ///< a comment (FORCE ...) is in its block
  /// It begins at a target in joint values, which is not corrected.
  bool starts_uncorrected : 1 = false;
  bool has_tool_length : 1 = false;  ///< a tool length acts (G43, the tool of a TOOL CALL)
  bool tool_in_spindle : 1 = false;  ///< the program has changed to `tool`
  bool tool_is_chosen : 1 = false;   ///< `tool` is the last T of the program
  bool exact_stop : 1 = false;       ///< the control stops at the end (G9, G61 of Fanuc, G61.1 of LinuxCNC)
  /// Points may be inserted: a feed move without exact stop and without a word that acts at its end.
  bool may_split : 1 = false;
  /// A feed move may be inserted before it: start and feed are known, no exact stop.
  bool may_jump : 1 = false;
  /// Of a move beside a contour, not of those that approach or leave it. A larger radius of the cutter moves
  /// the tool to this side.
  CutterSide cutter_side : 2 = CutterSide::none;
  bool may_insert_words : 1 = true;  ///< axis words may be inserted; false for a block with G43, G44 or G49
};
static_assert(sizeof(Move) <= 264, "programs have millions of moves");

/// Whether the block of an arc stays at the height of its start: it has no word of the axis normal to its
/// plane and must not get one.
inline bool stays_flat(const Move& move) {
  return move.arc && move.arc->flat && !move.words[static_cast<std::size_t>(move.arc->normal)];
}

/// Length of the part of a line beside a corner that stays flat, at least (mm).
inline double flat_part_mm(double taken_mm) {
  return taken_mm > 0 ? 1.02 * taken_mm + 0.02 : 0;
}

/// The flat parts of a line between corners are shorter than this share of it.
inline constexpr double most_flat = 0.9;

/// Whether points may be inserted between the corners of a line, at which its height changes.
inline bool changes_height_inside(const Move& move) {
  if (!move.corners || move.arc || move.stays_whole || move.exact_stop || !move.may_insert_words)
    return false;
  const double flat_mm = flat_part_mm(move.corners->begin_mm) + flat_part_mm(move.corners->end_mm);
  return move.handling != Handling::held && flat_mm < most_flat * (move.end_mm - move.start_mm).norm();
}

/// Whether the block moves the tool. G92 and G10 L20 give coordinates to the place of the tool: they are
/// moves without way, whose words are shifted.
inline bool moves_tool(const Move& move) {
  const bool may_move = move.motion == Motion::feed || move.handling != Handling::held || move.relative ||
                        move.may_insert_words || move.cycle || move.called || move.makes_hole;
  return may_move || move.start_mm != move.end_mm;
}

/// Whether a word of `axis` is a difference from the move's start.
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

}  // namespace counterflex
