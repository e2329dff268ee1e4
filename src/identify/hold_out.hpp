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

/// Errors of a group's rows (m and rad, row by row).
struct RowErrors {
  std::vector<std::size_t> rows;
  std::vector<double> distance, angle;  ///< angle: empty without orientations
  std::vector<double> in_interval;      ///< shares of a row's numbers that lie in their 95 % intervals
};

/// After a step of the parameters from where `all` is linearised; `trained` has the steps of the sessions of
/// the rows outside. A group with own frames gets them from 20 of its rows, which are not tested. The
/// intervals come from the covariance of the training, frames included, and the noise of the session.
RowErrors errors_of(const FitProblem& problem, const RowGroup& group, const Fit& all, const FitStep& trained);

ErrorSummary summary(std::vector<double> errors);

}  // namespace counterflex
