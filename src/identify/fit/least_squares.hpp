#pragma once
/// Weighted linear least squares of all rows with priors; the unknowns of sessions are eliminated first.
#include <vector>

#include "identify/fit/residuals.hpp"

namespace counterflex {

/// One linearised row and its place.
struct LinearRow {
  RowResidual at;
  std::size_t session = 0;
  double weight = 1;                           ///< of the squared residual; 0: left out
  double distance_scale = 1, angle_scale = 1;  ///< real deviation over the stated one
};

/// The row with its scales and its weight.
struct WeightedRow {
  Eigen::VectorXd r;
  Eigen::MatrixXd J_p, J_s;
};
WeightedRow weighted(const LinearRow& row);

/// FitStep of parameters (scaled to their prior deviations inside) and of every session's unknowns.
struct FitStep {
  Eigen::VectorXd parameters;
  std::vector<Eigen::Matrix<double, session_unknowns, 1>> sessions;
  Eigen::MatrixXd covariance;  ///< of the parameters, priors included
};

/// Minimises sum |r + J_p dp + J_s ds|^2 + sum ((from_prior + dp) / prior)^2. `prior` are standard
/// deviations; 0 holds a parameter: its step is zero. Unknowns that no row determines keep their values. Rows
/// are taken in their order, so that the result does not depend on threads.
FitStep solve_rows(const std::vector<LinearRow>& rows, const std::vector<MeasurementKind>& kinds,
                   const Eigen::VectorXd& from_prior, const Eigen::VectorXd& prior);

}  // namespace counterflex
