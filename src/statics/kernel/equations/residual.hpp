#pragma once
/// The gradient of energy at a state. EQUATIONS.md, section 11.
#include "statics/kernel/equations/work.hpp"
#include "statics/model/joint_law.hpp"

namespace counterflex::kernel {

/// X = X * transform
template <class T>
COUNTERFLEX_INLINE void pass_transform(const Transform& transform, Frame<T>& X) {
  const auto& p = transform.p;
  const auto& R = transform.R;
  if (transform.shifts) COUNTERFLEX_UNROLL
  for (int i = 0; i < 3; ++i) X.p[i] += X.R(i, 0) * p[0] + X.R(i, 1) * p[1] + X.R(i, 2) * p[2];
  if (!transform.turns) return;
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 3; ++i) {
    const T a = X.R(i, 0), b = X.R(i, 1), c = X.R(i, 2);
    COUNTERFLEX_UNROLL
    for (int j = 0; j < 3; ++j)
      X.R(i, j) = a * R[static_cast<std::size_t>(j)] + b * R[static_cast<std::size_t>(3 + j)] +
                  c * R[static_cast<std::size_t>(6 + j)];
  }
}

template <int axis, class T>
COUNTERFLEX_INLINE void turn_about(T cosine, T sine, Frame<T>& X) {
  constexpr int j = (axis + 1) % 3, k = (axis + 2) % 3;
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 3; ++i) {
    const T a = X.R(i, j), b = X.R(i, k);
    X.R(i, j) = cosine * a + sine * b;
    X.R(i, k) = cosine * b - sine * a;
  }
}

/// Passes an actuator with errors of motion. Few machines have any.
template <class T>
[[gnu::noinline, gnu::cold]] void pass_with_errors(const FrameStep& step, Work<T>& work, Frame<T>& X) {
  const ErrorMotion& motion = at(work.machine.motions, step.motion);
  const T& q = at(work.state.joints, step.joint).q;
  const double offset = work.question.gravity * at(work.machine.actuator_offset, step.actuator);
  Frame<T> of_joint{};
  Vec6<T> velocity{};
  for (int l = 0; l < lane_count<T>; ++l) {
    const MotionNumbers numbers = motion_numbers(motion, lane(q, l), offset, work.question.errors);
    for (int i = 0; i < 9; ++i) lane(of_joint.R.c[i], l) = at(numbers, i);
    for (int i = 0; i < 3; ++i) lane(of_joint.p[i], l) = at(numbers, 9 + i);
    for (int i = 0; i < 6; ++i) lane(velocity[i], l) = at(numbers, 12 + i);
  }
  Frame<T> before = X, behind = X;
  if (step.direction > 0) {
    behind.R = X.R * of_joint.R;
    behind.p = X.p + X.R * of_joint.p;
  } else {
    before.R = times_transposed(X.R, of_joint.R);
    before.p = X.p - before.R * of_joint.p;
  }
  const Vec3<T> w = before.R * velocity.w;
  at(work.equations.joints, step.joint).s = {before.R * velocity.v + cross(behind.p, w), w};
  X = step.direction > 0 ? behind : before;
}

/// Passes a step from frame to frame; a joint's screw is noted.
template <class T>
COUNTERFLEX_INLINE void pass(const FrameStep& step, Work<T>& work, Frame<T>& X) {
  if (step.kind == StepKind::transform)
    return pass_transform(at(*work.question.transforms, step.transform), X);
  if (step.motion >= 0) return pass_with_errors(step, work, X);
  Vec6<T>& s = at(work.equations.joints, step.joint).s;
  const Vec3<T> axis{
      {X.R(0, step.axis) * step.sign, X.R(1, step.axis) * step.sign, X.R(2, step.axis) * step.sign}};
  if (step.kind == StepKind::slide) {
    s = {axis, {}};
    X.p = X.p + axis * (at(work.state.joints, step.joint).q * step.direction);
    return;
  }
  s = {cross(X.p, axis), axis};
  const JointState<T>& joint = at(work.state.joints, step.joint);
  const T cosine = joint.cosine, sine = joint.sine * (step.sign * step.direction);
  if (step.axis == 0)
    turn_about<0>(cosine, sine, X);
  else if (step.axis == 1)
    turn_about<1>(cosine, sine, X);
  else
    turn_about<2>(cosine, sine, X);
}

/// K times six strains.
template <class T>
COUNTERFLEX_INLINE Vec6<T> stiff(const Spring& spring, const Vec6<T>& x) {
  const auto K = [&](int i, int j) { return spring.K[static_cast<std::size_t>(6 * i + j)]; };
  Vec6<T> F;
  if (spring.shape == SpringShape::full) {
    COUNTERFLEX_UNROLL
    for (int i = 0; i < 6; ++i) {
      T sum = K(i, 0) * x[0];
      COUNTERFLEX_UNROLL
      for (int j = 1; j < 6; ++j) sum += K(i, j) * x[j];
      F[i] = sum;
    }
    return F;
  }
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 6; ++i) F[i] = K(i, i) * x[i];
  if (spring.shape == SpringShape::beam) COUNTERFLEX_UNROLL
  for (int i = 0; i < 6; ++i) {
    const int other = i < 3 ? 3 : 0, j = other + (i + 1) % 3, k = other + (i + 2) % 3;
    F[i] += K(i, j) * x[j] + K(i, k) * x[k];
  }
  return F;
}

/// c(y) of J_l(phi)^-1 = 1 - [phi] / 2 + c [phi]^2, y = phi^2
template <class T>
COUNTERFLEX_INLINE T jacobian_coefficient(T y) {
  return 1. / 12 + y * (1. / 720 + y * (1. / 30240 + y * (1. / 1209600)));
}

template <class T>
COUNTERFLEX_INLINE T note_turn(const Vec3<T>& turn, T& largest_squared) {
  const T y = dot(turn, turn);
  largest_squared = larger(largest_squared, y);
  return y;
}

/// phi = T' K (theta - theta_0) of a spring between the frames a and b.
template <class T>
COUNTERFLEX_INLINE void evaluate_spring(const Spring& spring, const Frame<T>& a, const Frame<T>& b,
                                        Work<T>& work, ElementTerms<T>& terms) {
  terms.p = b.p;
  if (spring.shape == SpringShape::isotropic) {  // the same in all axes; T' does not change its moment
    terms.turn = log_so3(times_transposed(b.R, a.R));
    note_turn(terms.turn, work.equations.largest_turn_squared);
    const Vec3<T> f = (b.p - a.p) * spring.K[0];
    terms.phi = {f, terms.turn * spring.K[21] + cross(b.p, f)};
    return;
  }
  Vec6<T> theta{transposed_times(a.R, b.p - a.p), log_so3(transposed_times(a.R, b.R))};
  terms.R = a.R;
  terms.turn = theta.w;
  const T y = note_turn(theta.w, work.equations.largest_turn_squared);
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 6; ++i) theta[i] -= work.question.preload * spring.theta_0[static_cast<std::size_t>(i)];
  const Vec6<T> F = stiff(spring, theta);
  const Vec3<T> once = cross(terms.turn, F.w), twice = cross(terms.turn, once);
  const Vec3<T> f = a.R * F.v, m = a.R * (F.w + once * 0.5 + twice * jacobian_coefficient(y));
  terms.phi = {f, m + cross(b.p, f)};
}

template <class T>
COUNTERFLEX_INLINE void note_force(const Vec6<T>& force, double length, T& largest) {
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 6; ++i) largest = larger(largest, magnitude(force[i]) * (i < 3 ? 1.0 : 1 / length));
}

/// Where a weight is, and the gradient of its energy.
template <class T>
struct WeightTerms {
  Vec3<T> f, p;
};
template <class T>
COUNTERFLEX_INLINE WeightTerms<T> weight_terms(const Weight& weight, Frame<T> X, const Work<T>& work) {
  const auto& g = work.machine.gravity;
  const double scale = -weight.mass * work.question.gravity;
  pass_transform(at(*work.question.transforms, weight.transform), X);
  return {{{all<T>(scale * g[0]), all<T>(scale * g[1]), all<T>(scale * g[2])}}, X.p};
}
template <class T>
COUNTERFLEX_INLINE Vec6<T> weight_gradient(const Weight& weight, const Frame<T>& X, const Work<T>& work) {
  const WeightTerms<T> terms = weight_terms(weight, X, work);
  return {terms.f, cross(terms.p, terms.f)};
}
template <class T>
COUNTERFLEX_INLINE void add_weights(const Weights& weights, const Frame<T>& X, const Work<T>& work,
                                    Vec6<T>& gradient) {
  for (int i = weights.first; i < weights.first + weights.count; ++i)
    gradient = gradient + weight_gradient(at(work.machine.weights, i), X, work);
}

template <class T>
COUNTERFLEX_INLINE void evaluate_joint(const FrameStep& step, const Vec6<T>& phi, Work<T>& work) {
  if (!step.is_joint() || step.actuator >= 0) return;
  JointTerms<T>& joint = at(work.equations.joints, step.joint);
  const T x = at(work.state.joints, step.joint).q - step.rest;
  const T force = step.k_change == 0 ? T(step.k * x) : joint_force(step.k, step.k_change, step.knee, x).force;
  joint.r = force - dot(joint.s, phi);
  work.equations.largest_force =
      larger(work.equations.largest_force,
             magnitude(joint.r) * (step.kind == StepKind::turn ? 1 / work.machine.length : 1.0));
}

/// What a series has at its end, and what its weights pull at its start beside that.
template <class T>
struct SeriesEnds {
  Vec6<T> phi, weight;
};

/// A series from frame A to frame B.
template <class T>
SeriesEnds<T> evaluate_series(int s, const Frame<T>& A, const Frame<T>& B, Work<T>& work) {
  const FlatMachine& machine = work.machine;
  const Series& series = at(machine.series, s);
  Vec6<T> inside{};
  add_weights(series.at_start, A, work, inside);
  for (int k = 0; k < series.count; ++k) {
    const int id = series.first + k;
    const Element& element = at(machine.elements, id);
    ElementTerms<T>& terms = at(work.equations.elements, id);
    const int before = k == 0 ? -1 : at(machine.elements, id - 1).node;
    Frame<T> a = before < 0 ? A : at(work.state.nodes, before),
             b = element.node < 0 ? B : at(work.state.nodes, element.node);
    for (int i = element.front; i < element.front + element.fronts; ++i) {
      const FrameStep& step = at(machine.steps, i);
      if (step.kind == StepKind::weight)
        at(work.equations.hanging, step.weight) = weight_gradient(at(machine.weights, step.weight), a, work);
      else
        pass(step, work, a);
    }
    for (int i = element.after; i < element.after + element.afters; ++i) pass(at(machine.steps, i), work, b);
    Vec6<T> at_start;
    if (element.kind == ElementKind::group) {
      terms.phi = {};
      Vec6<T> weight{};
      for (int branch = 0; branch < element.branches; ++branch) {
        const SeriesEnds<T> ends = evaluate_series(element.series + branch, a, b, work);
        terms.phi = terms.phi + ends.phi;
        weight = weight + ends.weight;
      }
      inside = inside + weight;
      at_start = terms.phi - weight;
    } else {
      evaluate_spring(at(machine.springs, element.spring), a, b, work, terms);
      at_start = terms.phi;
    }
    for (int i = element.front + element.fronts - 1; i >= element.front; --i) {
      const FrameStep& step = at(machine.steps, i);
      evaluate_joint(step, at_start, work);
      if (step.kind != StepKind::weight) continue;
      at_start = at_start - at(work.equations.hanging, step.weight);
      inside = inside + at(work.equations.hanging, step.weight);
    }
    for (int i = element.after; i < element.after + element.afters; ++i)
      evaluate_joint(at(machine.steps, i), terms.phi, work);
    if (before < 0) continue;
    Vec6<T> weights{};
    add_weights(at(machine.weights_of_node, before), at(work.state.nodes, before), work, weights);
    inside = inside + weights;
    Vec6<T>& node = at(work.equations.nodes, before);
    node = at(work.equations.elements, id - 1).phi - at_start + weights;
    note_force(node, machine.length, work.equations.largest_force);
  }
  Vec6<T> end{};
  add_weights(series.at_end, B, work, end);
  inside = inside + end;
  end = at(work.equations.elements, series.first + series.count - 1).phi + end;
  at(work.equations.ends, s) = end;
  return {end, inside};
}

/// Place of the load in the axes of M, from the common point.
template <class T>
COUNTERFLEX_INLINE Vec3<T> arm_of_load(const Work<T>& work) {
  const auto& p = work.machine.p_arm;
  return work.state.platform.p + work.state.platform.R * Vec3<T>{{all<T>(p[0]), all<T>(p[1]), all<T>(p[2])}};
}

template <class T>
COUNTERFLEX_INLINE void evaluate_tip(Work<T>& work) {
  Equations<T>& equations = work.equations;
  equations.tip = work.state.platform;
  pass_transform(work.machine.X_PT, equations.tip);
  if (!work.moves_actuators) return;
  equations.tip_error = {equations.tip.p * -1.0, {}};
  const auto& controlled = work.machine.controlled;
  if (controlled[3] || controlled[4] || controlled[5])
    equations.tip_error.w = log_so3(times_transposed(work.wanted_R, equations.tip.R));
}

template <class T>
void evaluate(Work<T>& work) {
  Equations<T>& equations = work.equations;
  equations.largest_force = equations.largest_turn_squared = T{};
  const Vec6<T> F = work.load * work.question.load;
  equations.platform = Vec6<T>{F.v, F.w + cross(arm_of_load(work), F.v)} * -1.0;
  equations.largest_wrench = all<T>(1);
  note_force(equations.platform, work.machine.length, equations.largest_wrench);
  Frame<T> base{};
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 3; ++i) base.R(i, i) = all<T>(1), base.p[i] = -work.origin[i];
  for (int s = 0; s < work.machine.chains; ++s) {
    const Vec6<T> phi = evaluate_series(s, base, work.state.platform, work).phi;
    equations.platform = equations.platform + phi;
    note_force(phi, work.machine.length, equations.largest_wrench);
  }
  note_force(equations.platform, work.machine.length, equations.largest_force);
  evaluate_tip(work);
}

}  // namespace counterflex::kernel
