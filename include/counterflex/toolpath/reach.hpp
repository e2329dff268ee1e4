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

/// The line along which a cycle drills a hole with a move, from the height at which its feed begins to the
/// bottom, in program coordinates (mm). Empty: it drills none, or place or depth are not known.
std::optional<Curve> hole_of_cycle(const Move& move);

/// Places to which that cycle takes the tool: the bottom of its hole, and its retract plane above it (mm).
std::vector<Vector3> places_of_cycle(const Move& move);

/// Whether the tool goes to places that are not known: a position or a depth is not a plain number, or a
/// cycle mills around the end of the move.
bool goes_to_unknown_places(const Move& move);

}  // namespace counterflex
