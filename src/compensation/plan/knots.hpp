#pragma once
/// From the sampled correction of a segment to the targets that are written.
#include <functional>

#include "compensation/plan/plan.hpp"
#include "compensation/solve/solver.hpp"

namespace counterflex {

/// Something to be interpolated, at a fraction.
using CorrectionAt = std::function<Correction(double u)>;

/// Knots (fractions, the last one `u1`) such that between them, at sixteenths and at `corners`, the straight
/// line between two of them is within `tolerance` of `at`: as few as possible, then evened out.
std::vector<double> choose_knots(const CorrectionAt& at, double u0, double u1,
                                 const std::vector<double>& corners, double tolerance);

/// How much of a correction is in effect along a segment: all of it, or evenly less towards an end that stays
/// as programmed. The share multiplies the correction, so that a share of the deviation remains.
struct Fade {
  bool from = false, to = false;  ///< whether the start and the end stay as programmed
  Correction programmed = Correction::Zero();

  bool acts() const { return from || to; }
  Correction operator()(double u, const Correction& full) const {
    if (!acts()) return full;
    const double share = from && to ? 0 : from ? u : 1 - u;
    return programmed + share * (full - programmed);
  }
};

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
