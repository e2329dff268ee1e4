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

  /// The step for a fit with these sets to the rows outside of a group. Other parameters have their values in
  /// the file.
  FitStep trained(const std::vector<ParameterSet>& sets, std::size_t group) const;

  /// Of the rows of each group, after the step that was trained without them.
  std::vector<RowErrors> errors(const std::vector<ParameterSet>& sets) const;

  const std::vector<RowGroup>& groups() const { return groups_; }

 private:
  const FitProblem& problem_;
  const Candidates& candidates_;
  const Fit& all_;
  std::vector<RowGroup> groups_;
  std::vector<NormalMatrices> training_;  ///< by group: of the rows outside
};

/// The sets that are kept, of `sets` in their order. A set stays where the held-out rows improve by more than
/// the standard error of that; tables and harmonics only if no group leaves the range of an actuator that the
/// other rows have.
std::vector<ParameterSet> climb(const Ladder& ladder, const FitProblem& problem,
                                const std::vector<ParameterSet>& sets, std::vector<LadderStep>& steps);

/// Held-out rows before and after a fit with the sets, by group and kind.
std::vector<HeldOutGroup> held_out(const Ladder& ladder, const Measurements& measurements,
                                   const std::vector<ParameterSet>& kept);

/// Where fits without one group each differ by more than the covariance explains, the misfit is not noise.
/// The deviation is then that of the delete-a-group jackknife. Source: Efron, Tibshirani, "An Introduction to
/// the Bootstrap" (1993), chapter 11.
void widen_by_groups(const Ladder& ladder, const std::vector<ParameterSet>& kept,
                     Eigen::MatrixXd& covariance);

}  // namespace counterflex
