#pragma once
/// Newton's iteration with a fixed schedule of tangents: no lane depends on another one.
#include "statics/kernel/coupled.hpp"

namespace counterflex::kernel {

template <class T>
struct Solved {
  Mask<T> accepted;  ///< the last step is small, and so is the residual at the solution
  T iterations;
  T contraction;  ///< the second step over the first one; 0: a single step
};

/// Whether every unknown is a number.
template <class T>
Mask<T> is_finite(const State<T>& state) {
  T sum{};
  const auto add = [&](const Frame<T>& X) {
    for (int i = 0; i < 9; ++i) sum += X.R.c[i] * 0.0;
    for (int i = 0; i < 3; ++i) sum += X.p[i] * 0.0;
  };
  for (const JointState<T>& joint : state.joints) sum += joint.q * 0.0;
  for (const Frame<T>& node : state.nodes) add(node);
  add(state.platform);
  return sum == 0.0;
}

template <class T>
COUNTERFLEX_INLINE bool has_tangent(const Schedule& schedule, int iteration) {
  return iteration > 31 || (schedule.tangents >> iteration & 1U) != 0;
}

/// The stress of the first tangent, at the state that was evaluated. Branches are before their group.
template <class T>
void set_first_stress(FirstStress first, Work<T>& work) {
  for (int i = 0; i < static_cast<int>(work.machine.elements.size()); ++i) {
    ElementTerms<T>& terms = at(work.equations.elements, i);
    if (first == FirstStress::of_elements) {
      terms.stress = terms.phi;
      continue;
    }
    terms.stress = {};
    if (first == FirstStress::none) continue;
    const Element& element = at(work.machine.elements, i);
    if (element.kind == ElementKind::spring) {
      const Vec6<T>& stress = at(work.start_stress, i);
      terms.stress = {stress.v, stress.w + cross(terms.p, stress.v)};
    }
    for (int b = 0; b < element.branches; ++b) {
      const Series& branch = at(work.machine.series, element.series + b);
      terms.stress = terms.stress + at(work.equations.elements, branch.first + branch.count - 1).stress;
    }
  }
}

/// Whether the residual at the state that was evaluated is small, and the state one that the equations hold
/// for.
template <class T>
Mask<T> is_balanced(const Work<T>& work) {
  const Equations<T>& e = work.equations;
  return (e.largest_force <=
          residual_tolerance * e.largest_wrench + closure_tolerance * work.machine.stiffest) &
         (e.largest_turn_squared <= largest_spring_turn * largest_spring_turn) & is_finite(work.state);
}

/// Solves the phase of the problem from the states of its machines, in the lanes that are `active`. The
/// equations are evaluated at the solution at last. `contraction`: a bound for the first step, where one is
/// known; else infinite. Calls `judge(active)` behind each factorisation of a tangent.
template <class T, class Judge>
Solved<T> iterate(const Schedule& schedule, Mask<T> active, const T& contraction, Coupled<T>& coupled,
                  const Judge& judge) {
  Solved<T> solved{static_cast<Mask<T>>(opposite<T>(active) & active), {}, {}};
  Mask<T> is_small = solved.accepted;
  Work<T>& first = coupled.first();
  // Nothing is known of the contraction of a first step, but of Newton's on kinematics.
  T last = all<T>(coupled.phase.real ? 0 : first.machine.length);
  const bool is_exact =
      !coupled.phase.real || !first.machine.has_hanging_weights;  // tangents: else steps contract slowly
  for (int k = 0;; ++k) {
    Mask<T> is_solved = active & is_small;
    coupled.for_each([&](Work<T>& work) {
      evaluate(work);
      is_solved = is_solved & is_balanced(work);
    });
    solved.accepted = solved.accepted | is_solved;
    active = active & opposite<T>(solved.accepted);
    if (k == schedule.most || !any<T>(active)) return solved;
    if (has_tangent<T>(schedule, k)) {
      if (k == 0) set_first_stress(schedule.first, coupled.real);
      coupled.real.stressed = k > 0 || schedule.first != FirstStress::none;
      factor(coupled);
      judge(active);
    }
    coupled.real.predicts_stress = has_tangent<T>(schedule, k + 1);
    find_step(coupled);
    const T size = first.step.size;
    is_small = size <= step_tolerance;
    // By the contraction that was seen the next step is small.
    const Mask<T> predicted = size * size <= step_tolerance * last;
    if (has_tangent<T>(schedule, k))
      is_small = is_small | predicted;
    else if (is_exact)
      is_small = is_small | (predicted & (size <= small_chord));
    if (k == 0)
      is_small = is_small | (size * (contraction + size * (1 / first.machine.length)) <= step_tolerance);
    if (k == 1) solved.contraction = select<T>(active, size / larger(last, all<T>(1e-300)), T{});
    last = size;
    coupled.for_each([&](Work<T>& work) { take_step<T>(active, work); });
    solved.iterations += select<T>(active, all<T>(1), T{});
  }
}

/// Factors the tangents at the state of both machines, with their stress.
template <class T>
void factor_at_solution(Coupled<T>& coupled) {
  for (ElementTerms<T>& terms : coupled.real.equations.elements) terms.stress = terms.phi;
  coupled.real.stressed = coupled.problem.real.has_value();
  factor(coupled);
}

/// Calls `visit(i, x)` with the inverse x of every pivot of the last factors, in the order of unknowns. It is
/// zero of actuators, and of joints that turn freely about themselves.
template <class T, class Visit>
COUNTERFLEX_INLINE void visit_pivots(const Work<T>& work, const Visit& visit) {
  int i = 0;
  for (const JointFactor<T>& joint : work.factors.joints) visit(i++, joint.inverse);
  for (const NodeFactor<T>& node : work.factors.nodes)
    for (int k = 0; k < 6; ++k) visit(i++, node.L(k, k));
  for (int k = 0; k < 6; ++k) visit(i++, work.factors.L(k, k));
}

}  // namespace counterflex::kernel
