#pragma once
/// Constants of model, solve and theory: when an iteration has converged, what is zero, what is singular.
/// Lengths and angles together, in m and rad. Beside each are other values that tests/statics was run with,
/// batches and the kernel left out: "pass", or what fails.

namespace counterflex {

// Convergence.
inline constexpr double closure_tolerance = 1e-12;  ///< of every closure. 1e-13, 1e-11: pass.
inline constexpr double step_tolerance =
    1e-11;  ///< of the last step's largest component. 1e-12, 1e-10: pass.
/// Of iterations that converge quadratically. 30: pass.
inline constexpr int most_newton_steps = 60;
/// Of the paper's (2) without Hessians, and of (23). 100: pass.
inline constexpr int most_linear_steps = 200;
/// Per step of nominal kinematics: a linearisation that does not reach it is made again. 0.01: pass; 0.5: the
/// test of perfect machines without a load fails.
inline constexpr double slow_contraction = 0.1;

// Ways that are gone in parts, and jumps to another branch.
inline constexpr double first_part = 0.25;  ///< of a way to a loaded, imperfect machine: four stages at least
inline constexpr double smallest_part = 1.0 / 4096;  ///< of any way. 1/64 and 1/16384: pass.
/// A step that is off its prediction by more, as a share of it, is a jump. 0.15 and 1: fail the test that
/// states it.
inline constexpr double same_way = 0.5;
/// Unless it is off by less than this, in units of l. 1e-6 and 1e-2: fail the same test.
inline constexpr double jump_floor = 1e-4;
inline constexpr double largest_step =
    0.5;  ///< of an actuator in nominal kinematics, l or rad. 0.1 and 2: pass.
inline constexpr double same_place = 1e-6;  ///< two ways end there, in units of l. 1e-4: pass.
inline constexpr double bracket =
    1e-9;  ///< of the displacement of a critical state: what the header promises

// Zero.
/// Of the largest pivot, in closures and sums of stiffnesses. 1e-13 and 1e-9: pass.
inline constexpr double rank_threshold = 1e-11;
/// Of the largest pivot, where springs up to 1e14 N/m meet soft joints. 1e-14 and 1e-11: pass.
inline constexpr double rounding_threshold = 1e-13;
inline constexpr double moves_platform = 1e-6;  ///< share of a zero mode. 1e-9 and 1e-3: pass.
/// m/N, at the tip: 1e15 N/m and more is infinite. 1e-12: pass.
inline constexpr double rigid_compliance = 1e-15;
/// Of the closures at home, whose numbers people round. 1e-10 and 1e-4: pass.
inline constexpr double home_tolerance = 1e-7;

// Judgement.
/// Of the whole system. 1e12: pass; 1e8: two tests of struts that buckle fail.
inline constexpr double largest_condition = 1e10;
/// Of the matrix from actuators to controlled components. 1e4 and 1e8: pass.
inline constexpr double largest_jacobian_condition = 1e6;
/// Of pivots: what elimination hides is far below the largest condition. 1e9: the test of a
/// pendulum on a free joint fails.
inline constexpr double proving_ratio = 1e6;
inline constexpr double clear_eigenvalue =
    1e-3;  ///< further from zero than any solution's errors. 1e-5, 0.1: pass.
/// N/m: what is stiffer counts as this, and hides no condition. 1e7: pass; 1e11: the test of a
/// strut beside a stiff spring fails.
inline constexpr double stiff_enough = 1e9;

}  // namespace counterflex
