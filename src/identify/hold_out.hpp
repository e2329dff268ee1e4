#pragma once
/// Groups of rows that test fits which were made without them.
#include "counterflex/identify/identify.hpp"
#include "identify/fit/fit.hpp"

namespace counterflex {

struct RowGroup {
  std::string name;
  std::vector<std::size_t> rows;
  bool has_own_frames = false;  ///< whole sessions: their frames come from some of their own rows
};

/// By what a user asked for. No groups where there are too few rows.
std::vector<RowGroup> hold_out_groups(const FitProblem& problem, HoldOut kind);

/// What the held-out rows of a group show of parameters that are tried.
struct TestRows {
  std::vector<std::size_t> tests;     ///< the rows outside determine what these show of the parameters
  std::vector<std::size_t> untested;  ///< they do not: a fit without these rows cannot predict them
  std::vector<std::size_t> blind;     ///< these show nothing of the parameters
  std::vector<bool> seen_by_tests, seen_by_untested;  ///< by parameter
};

/// `trained` is the step of the rows outside from where `all` is linearised, `tried` the prior deviations of
/// the parameters, 0 for all others. A group with own frames gets them from 20 of its rows, which are in no
/// list.
TestRows test_rows(const FitProblem& problem, const RowGroup& group, const Fit& all, const FitStep& trained,
                   const Eigen::VectorXd& tried);

/// Errors of rows of a group (m and rad, row by row).
struct RowErrors {
  std::vector<std::size_t> rows;
  std::vector<double> distance, angle;  ///< angle: empty without orientations
  std::vector<double> in_interval;      ///< shares of a row's numbers that lie in their 95 % intervals
};

/// After the step `trained`. The intervals come from the covariance of the training, frames included, and the
/// noise of the session.
RowErrors errors_of(const FitProblem& problem, const RowGroup& group, const std::vector<std::size_t>& rows,
                    const Fit& all, const FitStep& trained);

ErrorSummary summary(std::vector<double> errors);

}  // namespace counterflex
