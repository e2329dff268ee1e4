#pragma once
/// The real machine and the nominal one that the controller knows, with the same actuators, as one system.
#include "statics/kernel/batch.hpp"
#include "statics/kernel/equations/step.hpp"

namespace counterflex::kernel {

/// What is solved at once: one of the machines or both, with actuators that are unknowns or held.
struct Phase {
  bool real = false, nominal = false, moves_actuators = false;
};

/// A problem in phases. Where all components are commanded, or none, one machine has the actuators, and the
/// other one follows.
inline std::vector<Phase> phases_of(const Problem& problem) {
  if (!problem.nominal) return {{.real = true}};
  constexpr Phase kinematics{.nominal = true, .moves_actuators = true};
  if (!problem.real) return {kinematics};
  int controlled = 0, commanded = 0;
  for (int j = 0; j < 6; ++j) {
    controlled += at(problem.machine().controlled, j);
    commanded += at(problem.machine().controlled, j) && at(problem.of_command, j);
  }
  if (commanded == controlled) return {kinematics, {.real = true}};
  if (commanded == 0) return {{.real = true, .moves_actuators = true}, {.nominal = true}};
  return {{true, true, true}};
}

/// What one solve of a problem works on. Without the nominal machine actuators are held; without the real one
/// the problem is one of kinematics.
template <class T>
struct Coupled final : Memory {
  const Problem problem;
  const std::vector<Phase> phases = phases_of(problem);
  Work<T> real, nominal;
  Phase phase{};
  // Each controlled component of the real or of the nominal tip, as actuators move it: an LU decomposition
  // with exchange of rows, lane by lane.
  std::vector<T> lu{};
  struct Swap {
    Mask<T> lanes;
  };
  std::vector<Swap> swaps{};

  explicit Coupled(const Problem& p)
      : problem(p), real(p.machine()), nominal(p.nominal ? *p.nominal->machine : p.machine()) {
    if (problem.real) real.question = *problem.real;
    if (problem.nominal) nominal.question = *problem.nominal;
    const std::size_t n = real.machine.actuator_joint.size();
    lu.resize(n * n), swaps.resize(n * n);
  }

  void begin(const Phase& next) {
    phase = next;
    real.moves_actuators = nominal.moves_actuators = phase.moves_actuators;
  }

  /// The machine whose results are given out.
  Work<T>& first() { return phase.real ? real : nominal; }

  template <class Visit>
  COUNTERFLEX_INLINE void for_each(const Visit& visit) {
    if (phase.real) visit(real);
    if (phase.nominal) visit(nominal);
  }

  /// The machine whose tip has component `j`.
  Work<T>& owner(int j) {
    if (phase.real != phase.nominal) return first();
    return at(problem.of_command, j) ? nominal : real;
  }
};

/// Calls `visit(row, j)` for every controlled component j.
template <class Visit>
COUNTERFLEX_INLINE void for_each_controlled(const FlatMachine& machine, const Visit& visit) {
  int row = 0;
  for (int j = 0; j < 6; ++j)
    if (at(machine.controlled, j)) visit(row++, j);
}

template <class T>
void factor_actuators(Coupled<T>& coupled) {
  const FlatMachine& machine = coupled.real.machine;
  const int n = static_cast<int>(machine.actuator_joint.size());
  T* const A = coupled.lu.data();
  for_each_controlled(machine, [&](int row, int j) {
    const auto& responses = coupled.owner(j).factors.responses;
    for (int a = 0; a < n; ++a) A[n * row + a] = at(responses, a)[j] * (j < 3 ? 1.0 : machine.length);
  });
  for (int k = 0; k < n; ++k) {
    for (int i = k + 1; i < n; ++i) {
      const Mask<T> swap = magnitude(A[n * i + k]) > magnitude(A[n * k + k]);
      at(coupled.swaps, n * k + i) = {swap};
      for (int j = 0; j < n; ++j) {
        const T x = A[n * k + j], y = A[n * i + j];
        A[n * k + j] = select<T>(swap, y, x);
        A[n * i + j] = select<T>(swap, x, y);
      }
    }
    const T inverse = 1.0 / A[n * k + k];
    A[n * k + k] = inverse;
    for (int i = k + 1; i < n; ++i) {
      const T l = A[n * i + k] * inverse;
      A[n * i + k] = l;
      for (int j = k + 1; j < n; ++j) A[n * i + j] -= l * A[n * k + j];
    }
  }
}

/// x from b, by the factors of `factor_actuators`.
template <class T>
void solve_actuators(const Coupled<T>& coupled, T* x) {
  const int n = static_cast<int>(coupled.real.machine.actuator_joint.size());
  const T* const A = coupled.lu.data();
  for (int k = 0; k < n; ++k)
    for (int i = k + 1; i < n; ++i) {
      const Mask<T> swap = at(coupled.swaps, n * k + i).lanes;
      const T u = x[k], v = x[i];
      x[k] = select<T>(swap, v, u);
      x[i] = select<T>(swap, u, v);
    }
  for (int i = 1; i < n; ++i)
    for (int j = 0; j < i; ++j) x[i] -= A[n * i + j] * x[j];
  for (int i = n - 1; i >= 0; --i) {
    for (int j = i + 1; j < n; ++j) x[i] -= A[n * i + j] * x[j];
    x[i] = x[i] * A[n * i + i];
  }
}

template <class T>
void factor(Coupled<T>& coupled) {
  coupled.for_each([](Work<T>& work) { factor(work); });
  if (coupled.phase.moves_actuators) factor_actuators(coupled);
}

/// The step of both machines that makes the linearised equations zero; its largest component and angle.
template <class T>
void find_step(Coupled<T>& coupled) {
  coupled.for_each([](Work<T>& work) { find_held_step(work); });
  if (coupled.phase.moves_actuators) {
    const FlatMachine& machine = coupled.real.machine;
    std::vector<T>& ways = coupled.first().step.actuators;
    for_each_controlled(machine, [&](int row, int j) {
      const Work<T>& owner = coupled.owner(j);
      at(ways, row) =
          (owner.step.platform[j] - owner.equations.tip_error[j]) * (j < 3 ? 1.0 : machine.length);
    });
    solve_actuators(coupled, ways.data());
    coupled.for_each([&](Work<T>& work) {
      work.step.actuators = ways;
      for (std::size_t a = 0; a < ways.size(); ++a)
        work.step.platform = work.step.platform - work.factors.responses[a] * ways[a];
    });
    for_each_controlled(machine, [&](int, int j) {
      Work<T>& owner = coupled.owner(j);
      owner.step.platform[j] = owner.equations.tip_error[j];
    });
  }
  coupled.for_each([](Work<T>& work) { find_inner_steps(work); });
  if (!coupled.phase.real || !coupled.phase.nominal) return;
  Step<T>&real = coupled.real.step, &nominal = coupled.nominal.step;
  real.size = larger(real.size, nominal.size);
  real.turn = nominal.turn = larger(real.turn, nominal.turn);
}

}  // namespace counterflex::kernel
