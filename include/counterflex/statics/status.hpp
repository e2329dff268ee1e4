#pragma once
/// What became of a waypoint: never an exception, never silence. MODEL, "Status of a waypoint".
#include <string_view>

namespace counterflex {

enum class Status {
  converged,
  not_converged,
  unreachable,     ///< no nominal configuration on the branch of home
  singular,        ///< the whole static system, or the matrix from actuators to controlled components
  unstable,        ///< a negative eigenvalue of the reduced Hessian at the solution or on the way to it
  outside_travel,  ///< an actuator leaves its range
};

std::string_view to_string(Status status);

}  // namespace counterflex
