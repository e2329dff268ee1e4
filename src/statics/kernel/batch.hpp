#pragma once
/// Waypoints that are solved at once, each from a start of its own.
#include <memory>
#include <optional>

#include "statics/kernel/cells/expansion.hpp"
#include "statics/kernel/equations/work.hpp"

namespace counterflex::kernel {

/// Bounds of the offset from tip to command in a cell, for the chords of short lines. Twists are (m, rad),
/// loads N and N m / l.
struct OffsetBounds {
  /// Of the position (row 0) and of the rotation vector (row 1): first derivatives by position, rotation
  /// vector and load; second derivatives by pairs of them; what the polynomial misses.
  std::array<std::array<double, 3>, 2> first{};
  std::array<std::array<std::array<double, 3>, 3>, 2> second{};
  std::array<double, 2> remainder{};
  double half_edge = 0;  ///< of the cell (m): the remainder is measured at its corners
  double load = 0;       ///< N: and with loads of this size in all components
};

/// The solutions of a question about a place: the state at the centre without a load, and how it changes with
/// the variables. A pure function of machine, question, centre and step.
struct StartCell {
  Variables variables;
  std::array<double, 3> centre{};    ///< position of the tip (m)
  std::array<double, 9> R{};         ///< its orientation, row by row
  std::vector<double> state;         ///< as `state_of`
  std::vector<double> cosine, sine;  ///< by joint
  /// Of the joints, filled up with zeros, of the twists of nodes and platform, of a target's offset.
  Polynomials changes;

  bool only_translates = false;  ///< the platform does not turn with the position, to 1e-11 rad in the cell

  // Of a target's cell:
  std::vector<double> stress;  ///< by element, six numbers: at the centre
  Polynomials stress_changes;  ///< by element a block: first-order terms, and of a position and a load
  std::vector<double> pivots;  ///< at the centre without a load, actuators held
  /// The second step over the first one, with the tangent of this start: by what acts, under loads of
  /// `load_of_cells`, at most.
  std::array<double, 3> contraction{1, 1, 1};
  std::array<double, 6> offset{};  ///< from the tip to the command: position (m), rotation vector (rad)
  Polynomials offset_changes;      ///< all terms
  OffsetBounds bounds{};
};

/// What is solved. Of the controlled components of a tip, those `of_command` are wanted of the nominal
/// machine: they are commanded. The others are wanted of the real one.
struct Problem {
  std::optional<Question> real;     ///< none: nominal kinematics alone
  std::optional<Question> nominal;  ///< none: actuators are held
  std::array<bool, 6> of_command{};

  /// The machine whose results are given out.
  const FlatMachine& machine() const { return *(real ? real : nominal)->machine; }

  bool operator==(const Problem&) const = default;
};

/// Waypoints and their solutions, number after number. Of the waypoints, what a problem does not use may be
/// empty.
struct Batch {
  std::vector<double> p;    ///< 3 each: wanted tip, or a place near it (m)
  std::vector<double> R;    ///< 9 each: wanted orientation, row by row; where it is controlled
  std::vector<double> F;    ///< 6 each: wrench on the machine (N, N m), axes of M
  std::vector<double> rho;  ///< commanded actuator values; where they are held
  /// What joints of the real machine have more than the commanded values, for each actuator; empty: nothing.
  std::vector<double> lag;
  std::vector<double> start, nominal_start;  ///< states of each machine: one of each waypoint, or one of all
  std::vector<const StartCell*> cells, nominal_cells;  ///< instead: a cell of each waypoint for each machine

  bool wants_states = false, wants_pivots = false;
  std::optional<Variables> response_to{};  ///< responses are wanted

  std::vector<unsigned char> accepted;
  std::vector<int> iterations;
  /// Of the real machine's first step, or of both: the second step over the first; 0: none.
  std::vector<double> contraction;
  std::vector<double> actuators;         ///< commanded values that belong to the solution
  std::vector<double> tip, nominal_tip;  ///< of the machines that there are, 12 each: R row by row, p
  /// Of a waypoint with a cell: every pivot of the last tangent, which has the stress that the cell or the
  /// step before predicts, keeps `least_stiffness` of the cell's.
  std::vector<unsigned char> is_stiff;
  // If they are wanted, of the real machine, or of the nominal one where it is alone:
  std::vector<double> state;  ///< state_size each
  /// By element: force and moment about its end (N, N m), axes of M; of groups zero.
  std::vector<double> stress;
  std::vector<double> pivots;  ///< one of each unknown, actuators held; zero: an actuator or a free joint
  /// First derivatives of the solution by the variables `response_to`: for each of them the step of the
  /// unknowns (joints, then twists about the wanted tip), and of the nominal platform (a twist), if there is
  /// a real machine.
  std::vector<double> responses;
  /// And of the stress of the real machine, by variable and element as `stress`, where a load is one.
  std::vector<double> stress_responses;

  int count() const { return static_cast<int>(p.size() / 3); }

  /// Takes all waypoints and wishes out. The memory stays.
  void clear();
};

/// Which stress the first tangent has. Later ones have what the last linear step predicted: with the stress
/// of an iterate that misses the errors of assembly, Newton diverges (EQUATIONS.md, section 11).
enum class FirstStress { none, of_elements, of_cells };

struct Schedule {
  unsigned tangents = ~0U;  ///< bit k: iteration k factors its own tangent; the others take the last one
  int most = 30;            ///< iterations
  FirstStress first = FirstStress::none;
};

/// What the solves of one problem by one instance work on.
struct Memory {
  Memory() = default;
  Memory(const Memory&) = delete;
  virtual ~Memory() = default;
};

/// The kernel for one kind of numbers. It solves a batch whose solutions have their sizes.
struct Instance {
  std::unique_ptr<Memory> (*memory_of)(const Problem&);
  void (*solve)(Memory&, const Schedule&, Batch&);
  int lanes;
};

/// The scalar instance, and those of the vectors that the computer has. All give the same bits.
extern const Instance scalar_instance;
std::vector<Instance> all_instances();

/// Solves batches of a few problems, one after the other, in memory that it keeps for each of them.
class Solver {
 public:
  /// Solves a batch by that instance, or else by the fastest one for its size. What `problem` refers to
  /// outlives the solver. The solutions do not depend on what was solved before.
  void solve(const Problem& problem, const Schedule& schedule, Batch& batch, const Instance* by = nullptr);

 private:
  struct Kept {
    Problem problem;
    const Instance* instance;
    std::unique_ptr<Memory> memory;
  };
  Memory& memory_of(const Problem& problem, const Instance& instance);

  std::vector<Kept> kept_;
};

}  // namespace counterflex::kernel
