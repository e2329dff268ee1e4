#pragma once
/// Waypoints that are solved at once, each from a start of its own.
#include "work.hpp"

namespace counterflex::kernel {

/// The solutions of a question about a place: the state at the centre without a load, and how it changes with
/// the position of the tip, up to second order, and with the load. A pure function of machine, question,
/// centre and step.
struct StartCell {
  static constexpr int place_terms = 9;              ///< x y z xx yy zz xy xz yz (m, m2)
  static constexpr int all_terms = place_terms + 6;  ///< and the load (N, N m), where it acts
  static constexpr int stress_terms = 1 + 6;         ///< one, and the load
  std::array<double, 3> centre{};                    ///< position of the tip (m)
  std::vector<double> state;                         ///< as `state_of`
  std::vector<double> cosine, sine;                  ///< by joint
  int terms = place_terms;
  std::vector<double>
      changes;  ///< by unknown (joints, then the twists of nodes and platform): `terms` coefficients
  std::vector<double>
      stress;  ///< by element, six numbers: `stress_terms` coefficients; empty where no load acts
  std::vector<double> pivots;            ///< of a target's cell: at its centre without a load, actuators held
  std::array<double, 3> offset{};        ///< of a target's cell: from the wanted tip to the command (m)
  std::vector<double> offset_changes;    ///< and `terms` coefficients of each component
};

/// A machine whose pivots keep at least this share of their unloaded values is stable and as well conditioned
/// as without the load, up to this factor.
inline constexpr double least_stiffness = 0.5;

/// Numbers of waypoint after waypoint; what is not asked for may be null.
struct Batch {
  int count = 0;
  const double* p = nullptr;      ///< 3 each: wanted tip, or a place near it (m)
  const double* place = nullptr;  ///< 3 each: where cells are evaluated; null: at p
  const double* R = nullptr;      ///< 9 each: wanted orientation, row by row; where it is controlled
  const double* F = nullptr;      ///< 6 each: wrench on the machine (N, N m), axes of M
  const double* rho = nullptr;    ///< commanded actuator values; where no target is asked
  const double* start = nullptr;  ///< states
  long start_stride = 0;          ///< numbers from start to start; 0: all have the same
  const StartCell* const* cells = nullptr;  ///< else: a cell for each waypoint, which gives its start

  unsigned char* accepted = nullptr;
  int* iterations = nullptr;
  double* actuators = nullptr;  ///< commanded values that belong to the solution
  double* tip = nullptr;        ///< 12 each: R row by row, p
  double* state = nullptr;      ///< state_size each
  double* stress =
      nullptr;  ///< by element: force and moment about its end (N, N m), axes of M; of groups zero
  double* pivots = nullptr;         ///< FlatMachine::pivots each, actuators held; zero: a free joint
  unsigned char* is_stiff = nullptr;  ///< every pivot keeps `least_stiffness` of its cell's
};

/// Which stress the first tangent has. Later ones have what the last linear step predicted: with the stress
/// of an iterate that misses the errors of assembly, Newton diverges (EQUATIONS.md, section 11).
enum class FirstStress { none, of_elements, of_cells };

struct Schedule {
  unsigned tangents = ~0U;  ///< bit k: iteration k factors its own tangent; the others take the last one
  int most = 30;            ///< iterations
  FirstStress first = FirstStress::none;
};

/// The kernel for one kind of numbers.
struct Instance {
  void (*solve)(const FlatMachine&, const Question&, const Schedule&, Batch&);
  int lanes;
};

/// The scalar instance, and those of the vectors that the computer has.
extern const Instance scalar_instance;
std::vector<Instance> all_instances();

}  // namespace counterflex::kernel
