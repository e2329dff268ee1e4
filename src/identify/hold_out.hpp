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

/// Errors of a group's rows (m and rad, row by row) after a step of the parameters from where `rows` are
/// linearised; `trained` has the sessions' steps of the rows outside. `own` of a group with own frames: they
/// are found from 20 of its rows of each session, which are not tested.
struct RowErrors {
  std::vector<std::size_t> rows;
  std::vector<double> distance, angle;  ///< angle: empty without orientations
};
RowErrors errors_of(const FitProblem& problem, const RowGroup& group, const std::vector<LinearRow>& rows,
                    const FitStep& trained);

ErrorSummary summary(std::vector<double> errors);

}  // namespace counterflex
