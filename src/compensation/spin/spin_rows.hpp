#pragma once
/// The machine at the places of a path in every turn of the grid.
#include <array>
#include <span>
#include <vector>

#include "compensation/solve/solver.hpp"
#include "compensation/spin/spin_path.hpp"
#include "counterflex/compensation/options.hpp"

namespace counterflex {

/// A place of the path as programmed.
struct SpinRequest {
  ForwardRequest command;                 ///< without an orientation
  Pose wanted;                            ///< of the tip
  StatedTurns turns = StatedTurns::none;  ///< by the target, or by the control's rules for its language
};

/// A place in the turns of the grid. Where the machine does not come to a turn continuously from the
/// programmed one, the deviation is infinite; at `spin_zero` it is 0 then.
struct SpinRow {
  std::array<float, spin_count> deviation{};      ///< of the position (m)
  std::array<float, spin_count> margin{};         ///< to another configuration: rad, or 1 / condition
  std::array<Eigen::VectorXd, spin_count> rho{};  ///< actuators (m, rad), counted on from `spin_zero`
};

/// Solves the rows of requests from the programmed turn outwards.
std::vector<SpinRow> solve_rows(const Job& job, std::span<const SpinRequest> requests);

/// Forbids the turns in which an actuator comes near the end of its travel or leaves its stated turn.
/// `counted`: the programmed actuators at the place before, over full turns; then those of this place.
void keep_travel(const SpinRequest& request, Eigen::VectorXd& counted, SpinRow& row);

}  // namespace counterflex
