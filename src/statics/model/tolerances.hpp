#pragma once
/// When an iteration of this module has converged, and what is zero. Lengths and angles together, in m and rad.

namespace counterflex {

inline constexpr double closure_tolerance = 1e-12;  ///< of every closure
inline constexpr double step_tolerance = 1e-11;     ///< of the last step's largest component
inline constexpr int most_newton_steps = 60;        ///< iterations that converge quadratically
inline constexpr int most_linear_steps = 200;       ///< the paper's, which converge linearly

inline constexpr double first_part = 0.25;               ///< of a way to a loaded, imperfect machine
inline constexpr double smallest_part = 1.0 / 4096;      ///< of a way; a smaller one is not tried
inline constexpr double jump_floor = 1e-4;               ///< a surplus of a step over its prediction that may be a jump
inline constexpr double same_way = 0.5;                  ///< a surplus over it, of the predicted step, is a jump

inline constexpr double rank_threshold = 1e-11;      ///< of the largest pivot: less is zero, in closures and where stiffnesses are alike
inline constexpr double rounding_threshold = 1e-13;  ///< the same where stiff springs and soft ones meet
inline constexpr double moves_platform = 1e-6;       ///< share of a zero mode that moves the platform
inline constexpr double largest_condition = 1e10;    ///< of the whole system; above it is singular

}  // namespace counterflex
