#pragma once
/// A mechanism as a flat list of operations that are done for several waypoints side by side, one a lane of a vector
/// register. Plain data and pointers: the kernels that read it are compiled for other instruction sets than the rest and
/// must share no inline function with it. EQUATIONS.md, section 11.

namespace counterflex::lanes {

inline constexpr int width = 8;  ///< waypoints that are solved at once
inline constexpr int most_actuators = 9, most_series = 64;  ///< of a machine that kernels have room for
inline constexpr int most_displacement_degree = 4, most_monomials = 35;

enum class Operation { fixed, slide, turn, spring, group, mass };

/// A fixed transform; R row-major.
struct FixedPose {
  double R[9], p[3];
  bool turns, shifts;  ///< whether R and p are not identity
};

/// One element of a series. A joint moves along or about a coordinate axis of the frame before it.
struct Part {
  Operation operation;
  int fixed;            ///< index into Program::fixed
  int axis;             ///< 0 x, 1 y, 2 z
  double sign;          ///< of the axis
  int value;            ///< index of its first coordinate in the state; of a group: of its pose (R row-major, p)
  int row;              ///< of its first equation in the series; -1 for one without
  int actuator;         ///< number; -1 for others
  double k, rest;       ///< joints: N/m or N m/rad, m or rad
  double offset;        ///< actuators: added to the value while weights act (m or rad)
  bool passive;         ///< its spring is not felt by nominal kinematics
  const double* K;      ///< spring: 6x6 row-major, then theta_0 (6)
  int first_branch, branches;  ///< group: index into Program::series
  double mass, at[3];   ///< mass: kg; where it is in the frame before it (m)
};

/// A series between two frames. Rows: six of the closure, then one by free coordinate.
struct Series {
  const Part* parts;
  int part_count;
  int rows;
  int wrench;           ///< index of F in the state
  int step;             ///< index of its rows in the step
  int end;              ///< index in the state of the pose where it should end
  bool is_chain;        ///< it ends at the platform
  int first_actuator, actuators;  ///< into Program::actuator_numbers
  int inside, by_end, by_actuators;  ///< where its tangents begin among Region::tangents
  const bool* angular;  ///< by row, from the seventh on
  double mass;          ///< kg that weigh, those of branches included
};

struct Program {
  const Series* series;  ///< branches before the series that holds their group
  int series_count;
  const FixedPose* fixed[2];    ///< without and with assembly errors
  const int* actuator_numbers;
  int actuators;
  int states;            ///< length of the state: coordinates, wrenches, poses of groups, pose of the platform, standing
  int platform;          ///< index of the platform's pose in it
  int standing;          ///< and of the command (M, m) at which the state is an equilibrium, then 1; 0 where it is none
  int rows;              ///< of all series together; a step of everything has 6 more, the platform's twist
  int forward, target, response;  ///< where these begin among Region::tangents
  int tangents;          ///< how many numbers those are
  int most_parts;
  int most_free;         ///< coordinates of a series
  double length;         ///< l
  double floor_per_metre;  ///< 16 eps k_max
  double gravity[3];     ///< m/s2, axes of M
  bool branches_weigh;   ///< whether a branch of a group has masses
  double p_PT[3], R_PT[9], arm[3];  ///< tip in P; where the load acts in P
  const int* controlled;  ///< components of the tip, as many as actuators
  double R_MT_home[9];    ///< orientation that nominal kinematics keeps where it is controlled
};

/// What is known of the machine around a place: everything that lanes share. Matrices are row-major.
struct Region {
  double centre[3], half;      ///< the cube of commanded positions in which polynomials hold (M, m)
  int degree;                  ///< of the polynomials in (p - centre) / half
  const double* polynomials;   ///< of the actuators: all of one power after another
  const double* start;         ///< state from which turns and displacements count, without a load
  const double* cosine;        ///< of start's coordinates
  const double* sine;
  /// Of every series: inside, rows x rows, from (gap, gradient) to (dF, dx); by_end, rows x 6, from a step of its end;
  /// by_actuators, rows x actuators. Then forward, 6 x 6, from the platform's imbalance to its twist; target, 9 x 9, with the
  /// tip's error and the commanded position besides; response, (rows + 6) x 6, from a load to the step of everything.
  const double* tangents;
  double place[3];          ///< where the tangents were taken (M, m)
  const double* bend;       ///< of the actuators' change by the commanded position, by position: [actuator][by][of]; or null
  const double* straighten;  ///< 9 x n: what such a change of actuators does to the solution with `target`
  const double* displacement;  ///< (rows + 6) x monomials, of start, without a load, by the position in the cube below; or null
  int displacement_degree;
  double displacement_centre[3], displacement_half;  ///< M, m
  const double* kinematic;  ///< (6 + n) x (6 + n), target with errors of the controlled components and actuators; or null
};

/// Waypoints, structure of arrays. In: p, F. Out: the rest.
struct Batch {
  double p[3][width];   ///< forward: commanded position; target: wanted tip, on return the position to command (M, m)
  double F[6][width];   ///< at the tip, or where Program::arm says
  double tip[12][width];      ///< R row-major, p
  double iterations[width];
  double* rho;                ///< actuators x width
  bool converged[width];
};

/// What acts on the machine beside the load.
struct Acting {
  bool errors, weights;
};
inline constexpr Acting everything{true, true};

struct Question {
  bool target;   ///< else forward
  bool kinematics;  ///< actuators for the tip of the nominal machine: nothing yields to anything, forces are zero
  Acting acting;
  bool go_on;    ///< lanes that the last call, with the same things acting, has left at an equilibrium begin there, others at the
                 ///< region's start
};

/// Solves one batch. `memory` holds `doubles_needed` numbers, aligned to 64 bytes, and keeps the state from call to call.
using Solve = void (*)(const Program&, const Region&, const Question&, Batch&, double* memory);

/// Judges what `Solve` has just found, with the same arguments: true where a lane has converged and is proven stable. False
/// says nothing. `scratch` holds `doubles_of_certificate` numbers, aligned to 64 bytes.
using Judge = void (*)(const Program&, const Region&, const Question&, const Batch&, double* memory, double* scratch,
                       bool* stable);

/// Doubles of working memory that a kernel needs, and its certificate.
long doubles_needed(const Program& program);
long doubles_of_certificate(const Program& program);

/// The kernel for the computer that this runs on, and its name ("AVX-512", "AVX2", "SSE2", "plain").
struct Kernel {
  Solve solve;
  Judge judge;
  const char* name;
  int together;  ///< waypoints in one vector: their states stand side by side in memory
};

/// Entry `i` of the state that the last call has left for a lane.
inline double state_entry(const Kernel& kernel, const Program& program, const double* memory, int i, int lane) {
  const int vector = lane / kernel.together, within = lane % kernel.together;
  return memory[(static_cast<long>(vector) * program.states + i) * kernel.together + within];
}

/// Those that this computer can run, the best one last.
struct Kernels {
  Kernel list[3];
  int count;
};
Kernels all_kernels();
Kernel best_kernel();

}  // namespace counterflex::lanes
