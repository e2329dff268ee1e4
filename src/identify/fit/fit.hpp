#pragma once
/// The robust fit of parameters and frames to rows.
#include <functional>

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
  int threads = 1;
};

/// The deviations of rows of one session, in units of the stated ones.
struct SessionScale {
  double distance = 1, angle = 1;
};

struct Fit {
  Eigen::VectorXd values;             ///< of the varied parameters
  std::vector<SessionFrames> frames;  ///< by session
  std::vector<SessionScale> scales;
  std::vector<LinearRow> rows;  ///< linearised at `values` and `frames`
  Eigen::MatrixXd covariance;
  int iterations = 0;
};

/// Gauss-Newton with reweighted rows: Huber's weights, then Tukey's, which leave gross errors out. Steps that
/// leave a bound end there. `start` has frames; its values begin at the machine's.
Fit fit(const FitProblem& problem, std::vector<SessionFrames> start);

/// All rows at the given values.
std::vector<LinearRow> linearise(const FitProblem& problem, const Eigen::VectorXd& values,
                                 const std::vector<SessionFrames>& frames,
                                 std::vector<Configuration>& loaded);

/// The same fit where everything is taken as linear about `rows`: of the rows for which `is_used`, with the
/// parameters for which prior is positive. `origin` are the values at which `rows` are linearised. Weights
/// and scales stay.
FitStep refit(const FitProblem& problem, const std::vector<LinearRow>& rows, const Eigen::VectorXd& origin,
              const Eigen::VectorXd& prior, const std::function<bool(std::size_t)>& is_used);

/// The size of a row's residual in its own (robust) deviations, per component.
double ratio(const LinearRow& row);

}  // namespace counterflex
