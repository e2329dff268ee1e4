#pragma once
/// Noise from repeated readings, and the lack of fit beyond it.
#include "counterflex/identify/identify.hpp"
#include "identify/fit/fit.hpp"

namespace counterflex {

/// Throws at repeated readings whose session has no rows of their kind, and at places with one reading.
void check_repeats(const Measurements& measurements);

/// Fills `noise` and `repeatability`. Rows of one session at nearly equal states, equal forces and directions
/// are repeats, too. Rows that were left out of the fit do not count. A session whose repeats are all equal
/// has no entry: its noise is not known.
void fill_noise(const FitProblem& problem, const Fit& fit, Identification& result);

}  // namespace counterflex
