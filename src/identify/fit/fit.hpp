#pragma once
/// The robust fit of parameters and frames to rows.
#include "identify/fit/least_squares.hpp"

namespace counterflex {

/// What is fitted. Parameters that are not varied have the value of the machine.
struct FitProblem {
  const Machine& machine;
  const Measurements& measurements;
  const States& states;
  std::vector<Pose> X_MT_nominal;   ///< by state
  std::vector<std::size_t> varied;  ///< indices into `parameters(machine)`
  Eigen::VectorXd before, prior;    ///< of the varied: values of the machine file, standard deviations (SI)
  Eigen::VectorXd least;            ///< lower bounds (SI)
  Eigen::MatrixXd correlation;      ///< of what is known before
  int threads = 1;
};

struct Fit {
  Eigen::VectorXd values;             ///< of the varied parameters
  std::vector<SessionFrames> frames;  ///< by session
  std::vector<LinearRow> rows;        ///< linearised at `values` and `frames`, with weights and scales
  Eigen::MatrixXd covariance;
  int iterations = 0;
  bool is_converged = false;
};

/// Reweighted least squares: Huber's weights, then Tukey's, which leave gross errors out. Steps are those of
/// Levenberg and Marquardt: one that does not lower the weighted sum of squares is tried again with more
/// damping. Parameters that would leave a bound end there. `start` has frames; its values begin at the
/// machine's. Source of the schedule: Madsen, Nielsen, Tingleff, "Methods for non-linear least squares
/// problems" (2004), section 3.2.
Fit fit(const FitProblem& problem, std::vector<SessionFrames> start);

/// What the sessions do not know, from where their frames are.
std::vector<SessionUnknowns> unknowns_of(const FitProblem& problem, const std::vector<SessionFrames>& frames);

/// The size of a row's residual in its own (robust) deviations, per component.
double ratio(const LinearRow& row);

}  // namespace counterflex
