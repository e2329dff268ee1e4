#pragma once
/// The parts of an `Identification` that come from a fit.
#include "identify/candidates.hpp"
#include "identify/fit/fit.hpp"

namespace counterflex {

/// Parameters with a positive prior, their covariance, correlations and free combinations, and the machine.
/// `covariance` is that of all candidates; `fit` has their values, and the covariance of the rows alone.
void fill_parameters(const Machine& machine, const Candidates& candidates, const Fit& fit,
                     const Eigen::VectorXd& prior, const Eigen::MatrixXd& covariance, Identification& result);

/// Lack of fit, outliers, worst rows.
void fill_rows(const FitProblem& problem, const Fit& fit, Identification& result);

}  // namespace counterflex
