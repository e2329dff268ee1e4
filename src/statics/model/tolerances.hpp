#pragma once
/// Constants of statics: when an iteration has converged, what is zero, what is singular, where the kernel
/// starts. Lengths and angles together, in m and rad. Most comments give other values that were tried: by
/// tests/statics, which pass or fail, and by 36 whole runs over the samples and over programs of shops, whose
/// text has 140478 lines. The text is the same unless the comment gives a difference.
#include <cstddef>

namespace counterflex {

// Convergence.
/// Of every closure; and forces of the kernel may be those of the stiffest spring at it. 1e-13, 1e-11: pass.
inline constexpr double closure_tolerance = 1e-12;
/// Of the last step's largest component, or of the step behind it, by the contraction that was seen or
/// measured. 1e-12, 1e-10: pass.
inline constexpr double step_tolerance = 1e-11;
/// Of iterations that converge quadratically. 30 and 90: pass; 100: Newton's method finds a state beyond a
/// limit point, and the test of analyses that states it fails.
inline constexpr int most_newton_steps = 60;
/// Of the paper's (2) without Hessians, and of (23). 100: pass.
inline constexpr int most_linear_steps = 200;
/// Of the kernel's residual forces, against those that act.
inline constexpr double residual_tolerance = 1e-9;
/// Chords contract less evenly: they have to be small, too, and tangents complete. 1e-10 and 1e-8: pass. With
/// both, answers from different starts agree to 1e-11 (tests/statics/kernel/kernel_test.cpp); where tangents
/// leave out hanging weights, 9e-11 were seen.
inline constexpr double small_chord = 1e-9;
/// Per step of nominal kinematics: a linearisation that does not reach it is made again. So the last step
/// leaves no more than closures may miss. 0.03: pass; 0.2: the test of perfect machines without a load fails.
inline constexpr double slow_contraction = closure_tolerance / step_tolerance;

// Ways that are gone in parts, and jumps to another branch.
/// Of a way to a loaded, imperfect machine: four stages at least. 0.08: pass; 1: three tests that state it
/// fail.
inline constexpr double first_part = 0.25;
inline constexpr double smallest_part = 1.0 / 4096;  ///< of any way. 1/64 and 1/16384: pass.
/// A step that is off its prediction by more, as a share of it, is a jump. 0.2 and 0.8: fail the test that
/// states it.
inline constexpr double same_way = 0.5;
/// Unless it is off by less than this, in units of l. 3e-5 and 3e-4: fail the same test.
inline constexpr double jump_floor = 1e-4;
/// Of an actuator in nominal kinematics, l or rad. 0.15 and 1.5: pass.
inline constexpr double largest_step = 0.5;
/// Two ways end there, or two cells have it, in units of l: another branch is further away. Of two ways
/// alone, 1e-4: pass.
inline constexpr double same_place = 1e-6;
/// Of a tip that the kernel has found, in units of l: its equilibrium has it again. 1e-10 and 1e-8: pass.
inline constexpr double known_tip = 1e-9;
/// Of the displacement of a critical state: what the header promises.
inline constexpr double bracket = 1e-9;

// Zero.
/// Of the largest pivot, in closures, and in stiffnesses where springs up to 1e14 N/m meet soft joints.
/// Closures alone: 1e-13 and 1e-9 pass; stiffnesses alone: 1e-14 and 1e-11 pass.
inline constexpr double rank_threshold = 1e-12;
/// N/m or N m: smaller pivots of the kernel are those of struts that turn about themselves.
inline constexpr double least_pivot = 1e-9;
/// By which the second spring of a rigid closure is stiffer in tangents: without it some node has pivots of
/// zero. The root of the rounding error, 2^-52: a tangent loses as much to it as to the surplus. 1e-9 and
/// 1e-7 fail tests of the kernel.
inline constexpr double closure_surplus = 0x1p-26;
/// N/m, of the springs that close series of nominal kinematics. Any stiffness does; its rounding errors are
/// far below `least_pivot`.
inline constexpr double kinematic_stiffness = 1e3;
inline constexpr double moves_platform = 1e-6;  ///< share of a zero mode. 1e-9 and 1e-3: pass.
/// m/N, at the tip: 1e15 N/m and more is infinite. 1e-12: pass.
inline constexpr double rigid_compliance = 1e-15;
/// Of the closures at home, whose numbers people round. 1e-10 and 1e-4: pass.
inline constexpr double home_tolerance = 1e-7;

// Judgement.
/// Of the whole system. 3e9 and 1e12: pass; 1e8: two tests of struts that buckle fail.
inline constexpr double largest_condition = 1e10;
/// Of the matrix from actuators to controlled components. 1e4 and 1e8: pass.
inline constexpr double largest_jacobian_condition = 1e6;
/// Of pivots: what elimination hides is far below the largest condition. 3e5 and 3e6: pass; 1e9:
/// the test of a pendulum on a free joint fails.
inline constexpr double proving_ratio = 1e6;
/// Further from zero than any solution's errors. 1e-5, 0.1: pass.
inline constexpr double clear_eigenvalue = 1e-3;
/// N/m: what is stiffer counts as this, and hides no condition. 1e7 and 3e9: pass; 1e11:
/// the test of a strut beside a stiff spring fails.
inline constexpr double stiff_enough = 1e9;
/// A pivot of the kernel that keeps this share of its unloaded value is as stable and as well conditioned as
/// without the load, up to this factor. 0.2: pass; 0.8: batches leave too much to single solves, six tests
/// fail.
inline constexpr double least_stiffness = 0.5;
/// Where tangents leave out how hanging weights turn, their pivots judge stability if a displacement (in
/// units of l) contracts to less than this share in each of four steps, or to the step tolerance. 1e-7 and
/// 1e-5: pass. 0.6: pass; 0.1: the proof of machines with masses fails.
inline constexpr double test_displacement = 1e-6, judging_contraction = 0.3;

// Cells.
/// Edges, in units of l; straight: one chain only slides, so that nominal kinematics does not bend. Bent:
/// 0.02: three times the time of short programs; 0.08: three tests of batches fail. Straight: 1/24: 1.3 times
/// the time; 0.35: no less than with 1/8.
inline constexpr double bent_edge = 1.0 / 24, straight_edge = 1.0 / 8;
/// rad: a start misses by some micrometres at half of it. 0.017 and 0.15: pass, in the same time.
inline constexpr double turn_edge = 0.05;
/// Cells are sampled under 250 N, under which machines deflect by micrometres to millimetres (100 N: the same
/// steps). Lines inside a cell are bounded under such loads. What polynomials miss under loads in other
/// directions is within twice what is measured (tests/statics/solve/batch_lines_test.cpp). 80 and 750 N: a
/// line of a cut is bounded too seldom, a test fails; 14 texts, 10 lines less and 40 more. Margin 1: the same
/// texts, but no proof; 6: the same test fails.
inline constexpr double load_of_cells = 250, remainder_margin = 2;
/// Of a term at the rim of its cell (m; angles times l). Steps of a waypoint of the bench's hexapod: 1.1;
/// with 1e-7 1.2, with 5e-7 1.9 (a sixth slower). Other machines take as many steps with all three; none
/// takes fewer with 1e-9.
inline constexpr double negligible_term = 2e-8;
/// That all tables of a run keep; the oldest quarter is forgotten at once. The bench's fine path of 200,000
/// blocks makes 261 cells; with 20 MB 356, with 9 MB of each kind 1066, a sixth more instructions. Its run
/// with reports takes 64 MB.
inline constexpr std::size_t bytes_of_cells = 22'000'000;

}  // namespace counterflex
