#pragma once
/// Places of the original path. They do not depend on how a text divides it.
#include <optional>
#include <span>
#include <vector>

#include "compensation/solve/solver.hpp"
#include "counterflex/compensation/options.hpp"

namespace counterflex {

/// Parts of a stretch without places, at whose ends it is looked at where it may curve.
inline constexpr int eighths = 8;

/// Steps of a segment at most, where tables of errors of motion or turning points need more: 0.25 mm on a
/// line of a metre.
inline constexpr double most_steps = 4096;

/// How far a segment goes around an arc or turns the tool, the larger angle (rad).
double angle_along(const Segment& segment);

/// Steps along a segment in which no axis passes more than about one position of a table of errors of motion:
/// as if axes went as far as the tip goes, and turned as if it were at the machine's length from them. 1
/// without tables.
int steps_of_tables(const Job& job, const Segment& segment);

/// Equal steps along a feed move; a rapid is one.
int steps_along(const Job& job, const Segment& segment);

/// Sets `fractions` to those inside a segment, increasing: corners of the force, where joints reverse, where
/// they pass positions of their tables of errors, and between `steps` equal parts.
void fractions_inside(const Job& job, PlaceSolver& solver, std::size_t segment, int steps,
                      ForceCursor& cursor, std::vector<double>& fractions);

/// A part of a segment between two fractions, and the forces at its ends, between which it may change evenly.
struct ForceChord {
  std::size_t segment = 0;
  double u0 = 0, u1 = 1;
  Vector6 F0 = Vector6::Zero(), F1 = Vector6::Zero();
};

/// How much a line may bend in such a part, where the force has corners inside of it: as
/// `PlaceSolver::bend_along`. Infinite around an arc, where the tool turns, and where the force steps or a
/// joint reverses inside of it.
LineBend bend_of(const Job& job, PlaceSolver& solver, const ForceChord& stretch,
                 std::span<const double> corners, ForceCursor& cursor);

/// The places of a segment.
struct SegmentPlaces {
  std::vector<double> fractions{};  ///< increasing, the last one 1
  /// Where corners of the force are left out: by how much the tip bends between the ends of the segment, at
  /// most, while its command goes straight (m). Between places inside of it: twice as much.
  std::optional<double> bend{};
};

/// The places that `solve_pieces` describes, in steps of at most one position of the tables of errors of
/// motion. A rapid has its end as its only place.
void places_along(const Job& job, PlaceSolver& solver, std::size_t segment, ForceCursor& cursor,
                  SegmentPlaces& places);

}  // namespace counterflex
