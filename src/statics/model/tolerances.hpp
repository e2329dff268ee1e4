#pragma once
/// When an iteration of this module has converged, what is zero, and what is singular: all constants of
/// model, solve and theory. Lengths and angles together, in m and rad. "Tests" are those of tests/statics,
/// run with other values of a constant: they pass between the values that a line names, and nothing fails
/// beyond them where no test is named.

namespace counterflex {

// Convergence.
inline constexpr double closure_tolerance = 1e-12;  ///< of every closure
inline constexpr double step_tolerance = 1e-11;     ///< of the last step's largest component
inline constexpr int most_newton_steps = 60;        ///< of iterations that converge quadratically
inline constexpr int most_linear_steps = 200;       ///< of the paper's (2) without Hessians, and of (23)
inline constexpr double slow_contraction =
    0.1;  ///< per step: a linearisation that does not reach it is made again

// Ways that are gone in parts, and jumps to another branch.
inline constexpr double first_part = 0.25;           ///< of a way to a loaded, imperfect machine
inline constexpr double smallest_part = 1.0 / 4096;  ///< of any way
inline constexpr double same_way =
    0.5;  ///< a step that is off its prediction by more, as a share of it, is a jump
inline constexpr double jump_floor = 1e-4;  ///< unless it is off by less than this, in units of l
inline constexpr double largest_step =
    0.5;  ///< of an actuator at once in nominal kinematics, in units of l or rad
inline constexpr double same_place = 1e-6;  ///< two ways end there, in units of l
inline constexpr double bracket = 1e-9;     ///< of the displacement of a critical state

// Zero.
inline constexpr double rank_threshold =
    1e-11;  ///< of the largest pivot, in closures and sums of stiffnesses
inline constexpr double rounding_threshold =
    1e-13;  ///< of the largest pivot, where springs up to 1e14 N/m meet soft joints
inline constexpr double moves_platform = 1e-6;     ///< share of a zero mode that moves the platform
inline constexpr double rigid_compliance = 1e-15;  ///< m/N, at the tip
inline constexpr double home_tolerance = 1e-7;     ///< of the closures at home, whose numbers people round

// Judgement.
inline constexpr double largest_condition = 1e10;  ///< of the whole system
inline constexpr double largest_jacobian_condition =
    1e6;  ///< of the matrix from actuators to controlled components
inline constexpr double proving_ratio =
    1e6;  ///< of pivots: what elimination hides is far below the largest condition
inline constexpr double clear_eigenvalue = 1e-3;  ///< further from zero than the errors of any solution
inline constexpr double stiff_enough = 1e9;  ///< N/m: what is stiffer counts as this, and hides no condition

}  // namespace counterflex
