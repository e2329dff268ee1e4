#pragma once
/// Weighted linear least squares of all rows with priors; the unknowns of sessions are eliminated first.
#include <functional>
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

using SessionVector = Eigen::Matrix<double, session_unknowns, 1>;

/// What is unknown of one session, and what is known of it without rows.
struct SessionUnknowns {
  std::vector<int> unknowns;                          ///< that its kind of rows can determine
  SessionVector from_prior = SessionVector::Zero();   ///< where they are, less where they are expected
  SessionVector information = SessionVector::Zero();  ///< 1 / variance of that; 0: nothing is known
};

/// A step of the unknowns of a session: `step` + `by_parameters` (dp - the step of the parameters) for
/// other steps dp. `covariance` is that at held parameters.
struct SessionStep {
  SessionVector step = SessionVector::Zero();
  Eigen::MatrixXd by_parameters;  ///< session_unknowns x parameters
  Eigen::Matrix<double, session_unknowns, session_unknowns> covariance;
};

/// What is known of the parameters without rows.
struct ParameterPrior {
  Eigen::VectorXd sigma;        ///< standard deviations (SI); 0 holds a parameter
  Eigen::MatrixXd correlation;  ///< the others are known as if nothing were known of held ones

  /// Of the parameters in their deviations: the inverse correlation of those that are not held; 1 for the
  /// others.
  Eigen::MatrixXd information() const;
};

/// A step of the parameters (scaled to their prior deviations inside) and of every session's unknowns.
struct FitStep {
  Eigen::VectorXd parameters;
  std::vector<SessionStep> sessions;
  Eigen::MatrixXd covariance;  ///< of the parameters, priors included
};

/// Normal matrices of the rows by session: its unknowns, the parameters (SI), the right-hand side.
using NormalMatrices = std::vector<Eigen::MatrixXd>;

/// Of the rows with weights for which `is_used`, on several threads; the sums do not depend on their number.
NormalMatrices normal_matrices(const std::vector<LinearRow>& rows,
                               const std::vector<SessionUnknowns>& sessions, Eigen::Index parameters,
                               const std::function<bool(std::size_t)>& is_used, int threads);

/// Those of the rows after a step of the parameters.
void move(const Eigen::VectorXd& parameters, NormalMatrices& normal);

/// Minimises sum |r + J_p dp + J_s ds|^2 + (from_prior + dp)^T C^-1 (from_prior + dp), C the covariance of
/// the prior, and the same of the sessions' unknowns. The step of a held parameter is zero. Unknowns that no
/// row determines keep their values. `damping` adds this many times the information of the priors to the
/// normal matrix, as Levenberg and Marquardt add to its diagonal: steps become short in prior deviations.
FitStep solve(const NormalMatrices& normal, const std::vector<SessionUnknowns>& sessions,
              const Eigen::VectorXd& from_prior, const ParameterPrior& known, double damping = 0);

/// The step of one session's unknowns from its normal matrix, parameters held.
SessionStep solve_session(const Eigen::MatrixXd& normal, const SessionUnknowns& unknowns);

}  // namespace counterflex
