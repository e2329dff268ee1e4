#pragma once
/// A machining program: its bytes and its moves. This module knows text and no machines.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/geometry/pose.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/program/move.hpp"

namespace counterflex {

/// Meaning of a length word without a decimal point. `units`: the unit of the program. `increments`: 0.001 mm
/// or 0.0001 inch. `unspecified`: read as units, but if the dialect allows both meanings, a block with such a
/// word is not rewritten; the program is refused.
enum class IntegerWords { unspecified, units, increments };

/// A block that is not corrected, and the reason.
struct LeftAlone {
  int line = 0;
  std::string why;
  /// The block moves axes to a position in machine coordinates, so it is not a move of the program.
  bool machine_position = false;
  int text_line = 0;   ///< as in Move
  bool feeds = false;  ///< such a block that may cut: a feed move of unknown length
};

/// Line of Program::text of a move or of an uncorrected block. Both are sorted by it.
template <typename Placed>
int line_in_text(const Placed& placed) {
  return placed.text_line > 0 ? placed.text_line : placed.line;
}

/// A remark for the report.
struct Remark {
  int line = 0;
  std::string what;
};

/// Distance by which a control may deviate from the path, from a block on: G64 P Q.
struct PathTolerance {
  int line = 0;
  std::optional<double> path_mm;   ///< P; empty: any distance
  std::optional<double> merge_mm;  ///< Q: moves that deviate from a line by less are merged
};

/// Lines of a text in which calls were expanded. From `text_line` on they are the lines of the file from
/// `line` on.
struct LineRun {
  int text_line = 1;
  int line = 1;
  /// Line of the file with the call, if these lines are copies of a body; 0: not copied.
  int called_from = 0;
};

/// A call that was not expanded, or a loop, a condition or a jump that was not executed.
struct UnexpandedCall {
  int text_line = 0;
  std::string why;
  bool is_flow = false;  ///< a loop, a condition or a jump
};

/// Result of expanding calls of subprograms and of executing loops, conditions and jumps.
struct Expansion {
  std::vector<LineRun> lines;  ///< empty: the text is the file's
  int file_lines = 0;
  std::size_t calls = 0;     ///< number of replaced calls; each repeat and each call in a copy counts
  int first_call = 0;        ///< line of the file
  std::size_t executed = 0;  ///< number of executed loops, conditions and jumps; each pass counts
  int first_executed = 0;    ///< line of the file
  bool in_order = false;     ///< the text has the blocks of the main program in the order in which they run
  std::vector<UnexpandedCall> unexpanded_calls;  ///< sorted by line
  /// Definitions in the text whose blocks do not run at their place: they are no longer called, or are
  /// between moves of a LinuxCNC program. Of a window: those in its text.
  std::vector<Span> unused;
};

/// From a move on, the diameter by which the control offsets contours.
struct CutterDiameter {
  std::size_t first_move = 0;  ///< index into Program::moves
  std::optional<double> mm{};  ///< D of G41.1 and G42.1 of LinuxCNC; empty: that of the tool in the control
};

/// The line of the file from which line `text_line` of Program::text comes.
int line_of_file(const Expansion& expansion, int text_line);

/// A coordinate system of moves: a work offset, shifted and rotated about Z by plain numbers of the program
/// (G10, G52, G92, G68, TRANS, ROT).
struct ProgramFrame {
  std::string work_offset{};            ///< "G54", "G54.1 P3", ...; empty: no offset was selected yet
  Vector3 origin_mm = Vector3::Zero();  ///< in coordinates of the offset
  double turn_rad = 0;                  ///< about Z, counter-clockwise
  /// By axis: position of the offset in machine coordinates, if the program sets it (G10 L2).
  std::array<std::optional<double>, 3> set_mm{};
  /// Pose of the work offset in the machine frame or the robot's world frame, if the program gives it with
  /// numbers ($BASE, wobjdata); lengths in mm, unlike other poses.
  std::optional<Pose> pose_mm{};
  /// Axis of the tool at points that give positions alone, if the program states it beside them (TLAXIS/).
  std::optional<Vector3> tool_axis{};

  bool operator==(const ProgramFrame&) const = default;
};

/// Whether the program itself gives the place of the frame's work offset (G10 L2, $BASE with numbers).
inline bool is_set(const ProgramFrame& frame) {
  return frame.pose_mm || frame.set_mm[0] || frame.set_mm[1] || frame.set_mm[2];
}

/// The pose of `frame` in the coordinates of its work offset (mm).
Pose in_offset(const ProgramFrame& frame);

/// Value of an external axis of a robot program, in mm or deg.
struct ExternalAxis {
  double value = 0;
  int line = 0;
  int unknown_in = 0;  ///< line of the first target at which it may have another value; 0: none
};

/// Targets that a robot passes without a stop: the control rounds the path there.
struct Zones {
  std::size_t count = 0;
  double largest_mm = 0;  ///< 0: no zone has a length that is known
  int largest_line = 0;   ///< of the first zone of that size
};

/// A program, or a window of one. In a window, `text` is some lines of the program, and `moves`, `left_alone`
/// and `counts` belong to these lines. The other members describe the program from its first line to the end
/// of the window.
struct Program {
  std::string file;
  std::string text;     ///< every byte of the input; with ReadOptions::expand_subprograms, calls are replaced
  std::string dialect;  ///< the dialect that was read, never "auto"
  IntegerWords integer_words = IntegerWords::unspecified;
  std::vector<Move> moves;
  /// Of a window: the last move of the window before it. Its spans refer to another text.
  std::optional<Move> before{};
  /// Of a window: the first move of the next window. Its spans refer to another text.
  std::optional<Move> after{};
  /// Coordinate systems of the moves; the first: no offset was selected yet.
  std::vector<ProgramFrame> frames{{}};
  /// Comments that are alone in their lines, of this window; the first: the last one before the window.
  std::vector<std::string> operations{""};
  /// The title of each of `operations`: the first comment after a tool change, a blank line or a rapid move.
  std::vector<std::string> operation_titles{""};
  std::vector<CutterDiameter> cutter_diameters{};  ///< in contours of this window, sorted by move
  std::vector<LeftAlone> left_alone;
  /// Texts outside of moves that follow the number of targets or the name of the file: the end of a loop, the
  /// size of its array, the name of a data list. In the order of the text.
  std::vector<Span> counts;
  std::vector<Remark> remarks;
  std::vector<PathTolerance> path_tolerances;  ///< each different one once
  /// The first target of a robot program whose external axes differ from those of the first target.
  std::optional<Remark> external_axes_move{};
  std::array<std::optional<ExternalAxis>, 6> external_axes{};  ///< E1 to E6 at the first target that has them
  Zones zones{};
  std::size_t block_count = 0;  ///< lines with at least one word
  std::size_t evaluated = 0;    ///< number of words that were variables or expressions and were evaluated
  Expansion expansion{};
};

/// The move before `moves[index]`, in this window or the one before it; null if there is no such move.
inline const Move* move_before(const Program& program, std::size_t index) {
  if (index > 0) return &program.moves[index - 1];
  return program.before ? &*program.before : nullptr;
}

/// The diameter that the program states for a move beside a contour (mm); empty: that of the tool in the
/// control.
inline std::optional<double> cutter_diameter_mm(const Program& program, std::size_t m) {
  const auto behind = std::ranges::upper_bound(program.cutter_diameters, m, {}, &CutterDiameter::first_move);
  return behind == program.cutter_diameters.begin() ? std::nullopt : (behind - 1)->mm;
}

/// By axis, whether the program has lost its position before move `m` (machine positions, tool changes): no
/// correction holds there any more. Where only '/', another work offset or what is not followed makes a
/// position unknown it does.
inline std::array<bool, 3> lost_axes(const Program& program, std::size_t m) {
  std::array<bool, 3> lost{};
  const Move &move = program.moves[m], *last = move_before(program, m);
  if (last == nullptr || last->block_delete) return lost;
  for (std::size_t axis = 0; axis < 3; ++axis)
    lost[axis] = last->known_end[axis] && !move.known_start[axis] && !move.moved_only_by_program[axis];
  return lost;
}

/// Whether the start of what follows may not be known: '/' may skip the block, or it is not followed.
/// `doubtful`: whether that of the block was not.
inline bool leaves_doubt(const Move& move, bool doubtful) {
  if (move.block_delete || (doubtful && !all_known(move.known_end))) return true;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (move.fixed[axis] || (move.known_start[axis] && !move.known_end[axis])) return true;
  return false;
}

// Modal drilling cycles of a Sinumerik.

/// The cycle of "MCALL CYCLE81(50, 0, 2, -20)", from MCALL to the end of the statement without its comment.
/// Empty if the cycle is not CYCLE81 to CYCLE89 or CYCLE840, or if a height is not a plain number.
std::optional<CalledCycle> modal_drilling_cycle(std::string_view statement);

}  // namespace counterflex
