#pragma once
/// The step that makes the linearised equations zero, and the state behind it.
#include "statics/kernel/equations/tangent.hpp"

namespace counterflex::kernel {

template <class T>
COUNTERFLEX_INLINE void condense_joint(const FrameStep& step, Work<T>& work, Vec6<T>& d) {
  if (!step.is_joint() || step.actuator >= 0) return;
  JointTerms<T>& joint = at(work.equations.joints, step.joint);
  const JointFactor<T>& factor = at(work.factors.joints, step.joint);
  const T g = joint.r - dot(joint.s, d);
  joint.y = g * factor.inverse;
  d = d + factor.u * g;
}

/// What the residuals inside a series add to the gradient at its end.
template <class T>
Vec6<T> condense_series(int s, Work<T>& work) {
  const FlatMachine& machine = work.machine;
  const Series& series = at(machine.series, s);
  Vec6<T> d{};
  for (int k = 0; k < series.count; ++k) {
    const int id = series.first + k;
    const Element& element = at(machine.elements, id);
    Vec6<T> of_element{};
    for (int branch = 0; branch < element.branches; ++branch)
      of_element = of_element + condense_series(element.series + branch, work);
    for (int i = element.front + element.fronts - 1; i >= element.front; --i)
      condense_joint(at(machine.steps, i), work, of_element);
    for (int i = element.after + element.afters - 1; i >= element.after; --i)
      condense_joint(at(machine.steps, i), work, of_element);
    if (k == 0) {
      d = of_element;
      continue;
    }
    const int node = at(machine.elements, id - 1).node;
    const NodeFactor<T>& factor = at(work.factors.nodes, node);
    Vec6<T> g = at(work.equations.nodes, node) + d - of_element;
    d = of_element + back_through(factor, g);
    solve_factored(factor.L, g);
    at(work.step.nodes, node) = g;
  }
  return d;
}

template <class T>
COUNTERFLEX_INLINE void note_step(T x, T& largest) {
  largest = larger(largest, magnitude(x));
}

/// A joint's step, `z` being the twist across it and all that was eliminated before; z becomes that of the
/// rest.
template <class T>
COUNTERFLEX_INLINE void step_joint(const FrameStep& step, const Element& element, int first_actuator,
                                   Work<T>& work, Vec6<T>& z) {
  if (!step.is_joint()) return;
  const FlatMachine& machine = work.machine;
  JointTerms<T>& joint = at(work.equations.joints, step.joint);
  const auto way_of = [&](int slot) {
    return at(work.step.actuators, at(machine.actuators, first_actuator + slot));
  };
  T dq;
  if (step.actuator >= 0) {
    dq = at(work.step.actuators, step.actuator);
  } else {
    dq = dot(at(work.factors.joints, step.joint).u, z) - joint.y;
    if (work.moves_actuators)
      for (int i = 0; i < step.actuators_before; ++i)
        dq += at(work.factors.couplings, step.coupling + i) * way_of(at(machine.slots, element.slots + i));
  }
  z = z - joint.s * dq;
  joint.y = dq;
  const bool turns = step.kind == StepKind::turn;
  note_step(dq * (turns ? machine.length : 1.0), work.step.size);
  if (turns) note_step(dq, work.step.turn);
}

/// The wrench that a spring has behind the linear step: the stress of the next tangent, free of what a finite
/// turn does to stiff directions.
template <class T>
COUNTERFLEX_INLINE void predict_stress(const Spring& spring, const Vec6<T>& z, ElementTerms<T>& terms) {
  if (spring.shape == SpringShape::isotropic) {
    const Vec3<T> f = (z.v + cross(z.w, terms.p)) * spring.K[0];
    terms.stress = terms.phi + Vec6<T>{f, z.w * spring.K[21] + cross(terms.p, f)};
    return;
  }
  const Vec6<T> F = stiff(
      spring, Vec6<T>{transposed_times(terms.R, z.v + cross(z.w, terms.p)), transposed_times(terms.R, z.w)});
  const Vec3<T> f = terms.R * F.v;
  terms.stress = terms.phi + Vec6<T>{f, terms.R * F.w + cross(terms.p, f)};
}

/// Steps inside a series whose start frame moves by xi_A, and whose end frame by `zeta` more.
template <class T>
void step_series(int s, const Vec6<T>& zeta, const Vec6<T>& xi_A, Work<T>& work) {
  const FlatMachine& machine = work.machine;
  const Series& series = at(machine.series, s);
  Vec6<T> end = zeta;
  for (int k = series.count - 1; k >= 0; --k) {
    const int id = series.first + k;
    const Element& element = at(machine.elements, id);
    ElementTerms<T>& terms = at(work.equations.elements, id);
    Vec6<T> before{};  // the node at its start, against the series' start frame
    const int node = k == 0 ? -1 : at(machine.elements, id - 1).node;
    if (node >= 0) {
      before = forth_through(at(work.factors.nodes, node), end) - at(work.step.nodes, node);
      if (work.moves_actuators)
        for (int a = 0; a < series.actuator_count; ++a)
          before = before - at(work.factors.node_columns, node * machine.most_actuators + a) *
                                at(work.step.actuators, at(machine.actuators, series.actuators + a));
    }
    Vec6<T> z = end - before, start = xi_A + before;
    // Against the order of elimination: behind the element, then before it, the farthest first.
    for (int i = element.after; i < element.after + element.afters; ++i)
      step_joint(at(machine.steps, i), element, series.actuators, work, z);
    for (int i = element.front; i < element.front + element.fronts; ++i) {
      const FrameStep& step = at(machine.steps, i);
      step_joint(step, element, series.actuators, work, z);
      if (step.is_joint())
        start = start + at(work.equations.joints, step.joint).s * at(work.equations.joints, step.joint).y;
    }
    if (element.kind == ElementKind::group) {
      Vec6<T> stress{};
      for (int branch = 0; branch < element.branches; ++branch) {
        step_series(element.series + branch, z, start, work);
        const Series& of_branch = at(machine.series, element.series + branch);
        stress = stress + at(work.equations.elements, of_branch.first + of_branch.count - 1).stress;
      }
      if (work.predicts_stress) terms.stress = stress;
    } else if (work.predicts_stress) {
      predict_stress(at(machine.springs, element.spring), z, terms);
    }
    if (node >= 0) {
      at(work.step.nodes, node) = xi_A + before;
      end = before;
    }
  }
}

/// The platform's step if the actuators do not move.
template <class T>
void find_held_step(Work<T>& work) {
  Vec6<T> b = work.equations.platform * -1.0;
  for (int s = 0; s < work.machine.chains; ++s) b = b - condense_series(s, work);
  solve_platform(work, b);
  work.step.platform = b;
  for (T& way : work.step.actuators) way = T{};
}

/// The steps of everything, those of the platform and of the actuators being known.
template <class T>
void find_inner_steps(Work<T>& work) {
  const FlatMachine& machine = work.machine;
  Step<T>& step = work.step;
  step.size = step.turn = T{};
  for (int i = 0; i < 6; ++i) {
    note_step(step.platform[i] * (i < 3 ? 1.0 : machine.length), step.size);
    if (i >= 3) note_step(step.platform[i], step.turn);
  }
  for (int s = 0; s < machine.chains; ++s) step_series(s, step.platform, Vec6<T>{}, work);
  for (const Vec6<T>& node : step.nodes)
    for (int i = 3; i < 6; ++i) note_step(node[i], step.turn);
}

template <class T>
COUNTERFLEX_INLINE void move_frame(const Vec6<T>& xi, T share, Frame<T>& X) {
  const Mat3<T> E = exp_so3(xi.w * share);
  X.R = E * X.R;
  X.p = E * X.p + xi.v * share;
}

template <class T>
COUNTERFLEX_INLINE void move_joint(T dq, bool turns, JointState<T>& joint) {
  joint.q += dq;
  if (!turns) return;
  const T y = dq * dq, s = dq * sine_series(y), c = 1 - y * versine_series(y);
  const T cosine = joint.cosine, sine = joint.sine;
  joint.cosine = cosine * c - sine * s;
  joint.sine = sine * c + cosine * s;
}

/// Takes the step in the lanes that are `active`, shortened where its largest turn is larger than
/// `largest_turn`.
template <class T>
void take_step(const Mask<T>& active, Work<T>& work) {
  const T share =
      select<T>(active, smaller(all<T>(1), largest_turn / larger(work.step.turn, all<T>(1e-30))), T{});
  for (int j = 0; j < work.machine.joints; ++j)
    move_joint(at(work.equations.joints, j).y * share, at(work.machine.joint_turns, j) != 0,
               at(work.state.joints, j));
  for (int i = 0; i < work.machine.nodes; ++i)
    move_frame(at(work.step.nodes, i), share, at(work.state.nodes, i));
  move_frame(work.step.platform, share, work.state.platform);
}

}  // namespace counterflex::kernel
