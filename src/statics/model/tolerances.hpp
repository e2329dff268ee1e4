#pragma once
/// When an iteration of this module has converged; MODEL.md's figures. Lengths and angles together, in m and rad.

namespace counterflex {

inline constexpr double closure_tolerance = 1e-12;  ///< of every closure
inline constexpr double step_tolerance = 1e-11;     ///< of the last step's largest component
inline constexpr double jump_floor = 1e-4;         ///< a surplus of a step over its prediction that may be a jump

}  // namespace counterflex
