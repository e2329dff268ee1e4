#pragma once
/// Newton's iteration with a fixed schedule of tangents: no lane depends on another one.
#include <utility>

#include "step.hpp"

namespace counterflex::kernel {

/// Which stress the first tangent has. Later ones have what the last linear step foresaw: with the stress of
/// an iterate that misses the errors of assembly, Newton diverges (EQUATIONS.md, section 12).
enum class FirstStress { none, of_elements };

struct Schedule {
  unsigned tangents = ~0U;  ///< bit k: iteration k factors its own tangent; the others take the last one
  int most = 30;            ///< iterations
  FirstStress first = FirstStress::none;
};

inline constexpr double step_tolerance = 1e-11;  ///< largest component of the last step (m; angles times l)
inline constexpr double quadratic_range = 1e-6;  ///< a step below it may be the last by its contraction alone
inline constexpr double force_tolerance = 1e-9;  ///< of the residual forces, against those that act
inline constexpr double deflection_tolerance =
    1e-12;  ///< and what the stiffest spring has at this deflection (m)

template <class T>
struct Solved {
  Mask<T> accepted;  ///< the last step is small, and the residual at the solution is
  T iterations;
};

/// Whether every unknown is a number.
template <class T>
Mask<T> is_finite(const State<T>& state) {
  T sum{};
  const auto add = [&](const Frame<T>& X) {
    for (int i = 0; i < 9; ++i) sum += X.R.c[i] * 0.0;
    for (int i = 0; i < 3; ++i) sum += X.p[i] * 0.0;
  };
  for (const T& q : state.q) sum += q * 0.0;
  for (const Frame<T>& node : state.nodes) add(node);
  add(state.platform);
  return sum == 0.0;
}

template <class T>
COUNTERFLEX_INLINE bool has_tangent(const Schedule& schedule, int iteration) {
  return iteration > 31 || (schedule.tangents >> iteration & 1U) != 0;
}

/// Solves the question of `work` from its state, in the lanes that are `active`.
template <class T>
Solved<T> iterate(const Schedule& schedule, Mask<T> active, Work<T>& work) {
  const Mask<T> asked = active;
  Mask<T> converged = active & (active ^ active);
  T iterations{}, last = all<T>(1e300);
  for (int k = 0; k < schedule.most && any<T>(active); ++k) {
    evaluate(work);
    if (has_tangent<T>(schedule, k)) {
      work.stressed = !work.question.nominal && (k > 0 || schedule.first == FirstStress::of_elements);
      if (k == 0 && !work.stressed)
        for (ElementTerms<T>& terms : work.equations.elements) terms.stress = {};
      factor(work);
    }
    work.foresees = !work.question.nominal && k + 1 < schedule.most && has_tangent<T>(schedule, k + 1);
    find_step(work);
    // With the contraction that was seen the step behind this one is negligible; this one is taken.
    const T size = work.step.size;
    const Mask<T> done =
        (size <= step_tolerance) | ((size * size <= step_tolerance * last) & (size <= quadratic_range));
    last = size;
    take_step<T>(active, work);
    iterations += select<T>(active, all<T>(1), T{});
    converged = converged | (active & done);
    active = active & opposite<T>(done);
  }
  evaluate(work);
  const Equations<T>& e = work.equations;
  const Mask<T> balanced =
      e.largest_force <= force_tolerance * e.largest_wrench + deflection_tolerance * work.machine.stiffest;
  const Mask<T> in_range = e.largest_turn_squared <= largest_spring_turn * largest_spring_turn;
  return {static_cast<Mask<T>>(converged & balanced & in_range & is_finite(work.state) & asked), iterations};
}

/// How many pivots of the whole system are negative at the state, actuators held, those of rigid closures not
/// counted: the equilibrium is stable where there is none.
template <class T>
T count_negative_pivots(Work<T>& work) {
  for (ElementTerms<T>& terms : work.equations.elements) terms.stress = terms.phi;
  work.stressed = true;
  const bool target = std::exchange(work.question.target, false);
  factor(work);
  work.question.target = target;
  return work.factors.negative_pivots - 6.0 * work.machine.rigid_closures;
}

}  // namespace counterflex::kernel
