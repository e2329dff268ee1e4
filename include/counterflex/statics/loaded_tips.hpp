#pragma once
/// Tips of commanded poses, solved many at once. The kernel solves what it can. Every other pose is solved by
/// itself, from home.
#include <span>
#include <vector>

#include "counterflex/statics/batch_solver.hpp"

namespace counterflex {

/// The tip under the load, errors and weights. The pose is meaningful only if `converged`.
struct LoadedTip {
  Status status = Status::not_converged;
  Pose X_MT;
};

/// `compliance_at_tip` there. It is meaningful only if `converged`; `singular` where some wrench moves the
/// platform without resistance.
struct LoadedCompliance {
  Status status = Status::not_converged;
  Matrix6 C = Matrix6::Zero();
};

/// The answers to commanded places, each with the wrench at the tip there; neither directions nor actuators
/// are given. Each answer depends on the model and its own pose alone. Poses outside travel are not solved.
/// The part's fixture does not act. `table` has loads at the tip. Does not throw.
std::vector<LoadedTip> loaded_tips(const StartTable& table, std::span<const BatchRequest> poses);
std::vector<LoadedCompliance> loaded_compliances(const StartTable& table,
                                                 std::span<const BatchRequest> poses);

}  // namespace counterflex
