#pragma once
/// How far curves and moves reach: what a machine must be able to reach, and what a part takes up.
#include <optional>
#include <vector>

#include "counterflex/toolpath/toolpath.hpp"

namespace counterflex {

/// Fractions inside an arc, in order, at which its first turn is outermost along the axes of its frame; of a
/// line none.
std::vector<double> outermost_fractions(const Curve& curve);

/// Fractions of a curve at which `points_along` has its points.
std::vector<double> fractions_along(const Curve& curve);

/// The smallest box around a curve along the axes of its frame, as that of a move. Of a helix that is tilted
/// against them to within 2 % of its radius.
Extent extent_of(const Curve& curve);

/// Number of holes that a cycle of G-code drills with a move: under G91 each repeat drills the next one,
/// under G90 all repeats drill the same one.
int count_of_holes(const Move& move);

/// Fractions of the way of a move, in X and Y, at which its cycle of G-code drills; the last one is 1. Empty:
/// it drills no hole, or their places are not known.
std::vector<double> fractions_of_holes(const Move& move);

/// The bottom of the hole at one of these fractions, in program coordinates (mm).
Vector3 bottom_of_hole(const Move& move, double u);

/// The lines along which a cycle drills holes with a move, each from the height at which its feed begins to
/// the bottom, in program coordinates (mm). Empty: it drills none, or place or depth are not known.
std::vector<Curve> holes_of_cycle(const Move& move);

/// Places to which that cycle takes the tool: the bottoms of its holes, and its retract plane above each
/// (mm).
std::vector<Vector3> places_of_cycle(const Move& move);

/// Whether the tool goes to places that are not known: a position or a depth is not a plain number, or a
/// cycle mills around the end of the move.
bool goes_to_unknown_places(const Move& move);

}  // namespace counterflex
