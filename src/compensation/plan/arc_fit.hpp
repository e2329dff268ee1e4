#pragma once
/// Fits the words of an arc to a corrected one, judged on what a control reads, and divides it into pieces
/// where one arc does not fit.
#include <functional>

#include "compensation/plan/places.hpp"
#include "compensation/plan/plan.hpp"
#include "counterflex/program/rewrite.hpp"

namespace counterflex {

/// Of a piece of an arc, at least: twice its eighths.
inline constexpr int samples_of_piece = 2 * eighths;

/// A point at a fraction.
using PointAt = std::function<Vector3(double u)>;

/// The numbers of an orientation at a fraction.
using OrientationAt = std::function<OrientationNumbers(double u)>;

/// An arc of a program and the curve that its commands should follow.
struct ArcTask {
  const Move& move;
  const WriteOptions& options;
  Curve source;            ///< the move's own way, program coordinates (mm)
  PointAt commanded;       ///< wanted position and correction at a fraction of it, program coordinates (mm)
  OrientationAt turned{};  ///< the same of the orientation, for a move that has one
  double begin = 0, end = 1;    ///< fractions between which `commanded` has no step
  std::vector<double> corners;  ///< fractions where the force has corners
  /// Fractions at which pieces are judged, too, where the correction may wave between the others.
  std::vector<double> waves{};
  double tolerance_mm = 0;   ///< of the commanded curve, at equal fractions
  double chord_room_mm = 0;  ///< what chords may leave of it between their ends; 0: rounding takes it all
};

/// A piece of the arc between two fractions, from where the text holds the tool.
struct ArcPiece {
  double u0 = 0, u1 = 1;  ///< 1: it ends with the move's own end
  TextPosition from;
};

/// An arc that could be written for a piece. Where the block takes no word along the normal of its plane the
/// arc stays at the height of its start.
struct FittedArc {
  std::optional<Vector3> step_mm{};  ///< a line to this point, above or below the start, goes first
  Via via;
  Curve read;  ///< what a control reads
  /// From the commanded curve, at corners and 16 places or more, at most 22.5 degrees apart.
  double miss_mm = 0;
  bool sound = false;  ///< radius rules of controls hold, and its sweep is the wanted one
};

/// The best arc for a piece: with the original centre, seen from the start, if that is good enough,
/// else with a fitted one. The mismatch of its radii is at most the source's and one digit, else it is not
/// sound.
FittedArc fit_arc(const ArcTask& task, const ArcPiece& piece);

/// Whether the control turns the tool about one axis along a piece that is written as `read`. A piece that
/// changes nothing is as the original.
bool keeps_turn_limits(const ArcTask& task, const ArcPiece& piece, const Curve& read);

/// The whole of an arc of polar coordinates, which keeps them: only its pole is shifted with its start. It
/// may end beside its planned end. Its miss is the larger one of that with and without a line behind it.
FittedArc fit_polar_arc(const ArcTask& task, const TextPosition& from);

/// Whether nothing in the block's words changes when it is written as `read`.
bool keeps_words(const ArcTask& task, const ArcPiece& piece, const Curve& read);

/// Pieces of an arc, one after the other.
struct ArcPieces {
  std::vector<Via> vias;     ///< chords have no centre
  TextPosition held;         ///< where the text holds the tool behind them
  bool lack_digits = false;  ///< a chord is needed, and rounding leaves no room for it
};

/// What an arc is divided into between `begin` and `end` of its task: one arc if that is good enough, else
/// several, divided at corners first, then in halves, and what is half a turn at most into eight, and more
/// where that saves chords; chords of the commanded curve only where none of them fits. `from`: where the
/// text holds the tool.
ArcPieces divide_arc(const ArcTask& task, const TextPosition& from);

}  // namespace counterflex
