#pragma once
/// Lines and arcs of the tool tip in the machine frame M: the path that a program defines, without its text.
/// Lengths in m.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "counterflex/geometry/curve.hpp"
#include "counterflex/program/program.hpp"

namespace counterflex {

/// Where a part was touched off with the machine.
struct TouchedPlace {
  Vector3 p_MT = Vector3::Zero();  ///< the commanded position, in M (m)
  Vector3 axes =
      Vector3::Ones();  ///< 1 for each axis of M that is from there, 0 for one that the program sets
};

/// Where a work offset puts program coordinates.
struct WorkFrame {
  std::string name{};  ///< of the offset that was used ("G54"); empty: program coordinates are M
  Pose X_MW;           ///< as the control has it: a target in M is written as X_MW^-1 of it
  /// Wanted minus commanded position of the original program, axes of M (m).
  Vector3 datum_shift = Vector3::Zero();
  std::optional<TouchedPlace> touched{};  ///< what the shift comes from
  /// Where no datum is stated: the mean deviation of the unloaded machine along the feed moves, axes of M
  /// (m).
  std::optional<Vector3> common_shift{};
};

/// The same frame for all offsets of `program`.
std::vector<WorkFrame> one_frame(const Program& program, const WorkFrame& frame);

/// The wanted place of program coordinates: X_MW with the datum's shift.
Pose wanted_frame(const WorkFrame& frame);

/// One move. Rapid segments carry no cutting force and are corrected at their end only.
struct Segment {
  std::size_t move = 0;  ///< index into Program::moves
  int line = 0;
  bool cutting = false;        ///< a feed move (G1, G2, G3)
  std::size_t frame = 0;       ///< index into Toolpath::frames
  Curve wanted;                ///< of the tip, in M
  BoxedOptional<Turn> turn{};  ///< its orientation in M, where the program gives one
  double feed_m_s = 0;  ///< programmed feed, under G93 that of this move; 0 where no feed is programmed
  double s_start = 0;   ///< cutting path length at the start, from the program's start: feed moves only (m)
  double s_end = 0;
  /// Time at the start at programmed feeds, feed moves only; does not advance without a feed (s).
  double t_start = 0;
  double t_end = 0;
};

/// The wanted orientation at fraction `u`, where the program gives one.
std::optional<Matrix3> orientation_at(const Segment& segment, double u);

/// By how much the tool turns along the segment (rad).
double turn_of(const Segment& segment);

/// How far the path of a program has come where a window of it ends.
struct PathEnd {
  double s = 0;  ///< cutting path length (m)
  double t = 0;  ///< time at programmed feeds, feed moves only (s)
};

/// The path: all moves whose start and end are known in every axis.
struct Toolpath {
  std::vector<WorkFrame> frames;  ///< by index into Program::frames
  std::vector<Segment> segments;
  PathEnd end{};
};

/// Makes program axes count as known throughout that no target needs, those that the machine does not
/// control: where such a position is unknown it is taken to be the next one programmed. No word is inserted
/// for them.
void ignore_axes(Program& program, const std::array<bool, 3>& ignored);

/// The move's way in program coordinates, mm.
Curve curve_of(const Move& move);

/// The same in frame A, in which program coordinates have the pose `X_AP`, in m.
Curve curve_in(const Pose& X_AP, const Move& move);

/// How long a feed move takes at its programmed feed (s); 0: it gives no segment, or no feed is known.
double duration_of(const Move& move);

/// The smallest box around the move's way, in program coordinates, mm; of a spiral arc to within the mismatch
/// of its radii.
struct Extent {
  Vector3 least, most;
};
Extent extent_of(const Move& move);

/// Places along a curve that show how far it reaches: a line's ends, and points of an arc that are at most
/// 22.5 degrees apart, with those that are outermost along the axes of its frame. Begins with the start and
/// ends with the end.
std::vector<Vector3> points_along(const Curve& curve);

/// Builds the path of `program` in the machine frame; `frames` are those of its work offsets. Moves with an
/// axis that is not known at start and end give no segment; a move that neither goes nor turns gives none
/// either. `start`: of a window, where the path of the one before it ended.
Toolpath build_toolpath(const Program& program, const std::vector<WorkFrame>& frames,
                        const PathEnd& start = {});

}  // namespace counterflex
