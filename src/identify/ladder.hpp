#pragma once
/// Fits to some groups of rows, tested on the others: which sets of parameters stay, how well the result
/// predicts, how far parts of the rows agree.
#include "identify/candidates.hpp"
#include "identify/hold_out.hpp"

namespace counterflex {

/// Fits with sets of parameters to the rows outside of each group, all about where `all` is linearised.
class Ladder {
 public:
  /// Keeps references to everything but the groups.
  Ladder(const FitProblem& problem, const Candidates& candidates, const Fit& all,
         std::vector<RowGroup> groups);

  bool has(ParameterSet set) const;

  /// The candidates of a set, 0 for the others.
  Eigen::VectorXd prior_of(ParameterSet set) const;

  /// The step for a fit to the rows outside of a group. Parameters whose prior deviation is 0 have their
  /// values in the file.
  FitStep trained(const Eigen::VectorXd& prior, std::size_t group) const;

  /// By group: what its rows show of the parameters `tried`, where the others are fitted with `prior`.
  std::vector<TestRows> tests(const Eigen::VectorXd& prior, const Eigen::VectorXd& tried) const;

  /// Of rows of each group, after the step that was trained without it.
  std::vector<RowErrors> errors(const Eigen::VectorXd& prior,
                                const std::vector<std::vector<std::size_t>>& rows) const;

  const std::vector<RowGroup>& groups() const { return groups_; }

 private:
  const FitProblem& problem_;
  const Candidates& candidates_;
  const Fit& all_;
  std::vector<RowGroup> groups_;
  std::vector<NormalMatrices> training_;  ///< by group: of the rows outside
};

/// Prior deviations of the parameters that are kept, 0 for the others. Sets are tried in the order of `sets`.
/// A set stays where the held-out rows improve by more than the standard error of that; tables and harmonics
/// only if no group leaves the range of an actuator that the other rows have. The rows of at least two groups
/// have to test a set. Of a set that does not stay, those parameters do that no test has seen and that a row
/// shows which the other rows cannot predict; tables and harmonics do not stay then.
Eigen::VectorXd climb(const Ladder& ladder, const FitProblem& problem, const std::vector<ParameterSet>& sets,
                      std::vector<LadderStep>& steps);

/// Held-out rows before and after a fit with the kept parameters, by group and kind. Rows that the other rows
/// cannot predict are counted in `untested`.
std::vector<HeldOutGroup> held_out(const Ladder& ladder, const Measurements& measurements,
                                   const Eigen::VectorXd& kept, std::size_t& untested);

/// Where fits without one group each differ by more than the covariance explains, the misfit is not noise.
/// The deviation is then that of the delete-a-group jackknife. A parameter that is not seen by the rows
/// outside of one group keeps its deviation: the fit to these has the prior, which shows no scatter. Source:
/// Efron, Tibshirani, "An Introduction to the Bootstrap" (1993), chapter 11.
void widen_by_groups(const Ladder& ladder, const Eigen::VectorXd& kept, Eigen::MatrixXd& covariance);

}  // namespace counterflex
