#pragma once
/// From the sampled correction of a segment to the targets that are written.
#include "compensation/plan/plan.hpp"
#include "compensation/solve/solver.hpp"

namespace counterflex {

/// What knots between the ends of a segment must leave of the tolerance, before it is known how the tip
/// follows targets (m).
double room_for_knots(const Job& job, const Segment& segment);

/// Adds the knots of a stretch without steps of the correction along a line. `corners`: fractions of the
/// segment; `fade`: along all of it. Returns the reason if there are no knots.
std::optional<Failure> add_knots(const Job& job, PlaceSolver& solver, std::size_t segment,
                                 const CorrectionCurve& stretch, const Fade& fade,
                                 const std::vector<double>& corners, PlannedSegment& planned);

/// Sets how much the tip moves for a change of target at the end of a segment, at most.
std::optional<Failure> set_gain(const Job& job, PlaceSolver& solver, std::size_t segment, double& gain);

/// For a block that must stay one: leaves the knot at its end, and notes what its inside misses.
void forbid_splitting(const Segment& segment, PlannedSegment& planned);

}  // namespace counterflex
