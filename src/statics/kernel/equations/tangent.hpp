#pragma once
/// The second derivative of energy, eliminated block by block: joints, nodes, platform. EQUATIONS.md,
/// section 11.
#include "statics/kernel/equations/residual.hpp"

namespace counterflex::kernel {

/// [p] A
template <class T>
COUNTERFLEX_INLINE Mat3<T> skew_times(const Vec3<T>& p, const Mat3<T>& A) {
  Mat3<T> B;
  COUNTERFLEX_UNROLL
  for (int j = 0; j < 3; ++j) {
    B(0, j) = p[1] * A(2, j) - p[2] * A(1, j);
    B(1, j) = p[2] * A(0, j) - p[0] * A(2, j);
    B(2, j) = p[0] * A(1, j) - p[1] * A(0, j);
  }
  return B;
}

/// A [p]
template <class T>
COUNTERFLEX_INLINE Mat3<T> times_skew(const Mat3<T>& A, const Vec3<T>& p) {
  Mat3<T> B;
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 3; ++i) {
    B(i, 0) = A(i, 1) * p[2] - A(i, 2) * p[1];
    B(i, 1) = A(i, 2) * p[0] - A(i, 0) * p[2];
    B(i, 2) = A(i, 0) * p[1] - A(i, 1) * p[0];
  }
  return B;
}

/// A times the 3 x 3 block of a spring's K that begins at (row, column).
template <class T>
COUNTERFLEX_INLINE Mat3<T> times_block(const Mat3<T>& A, const Spring& spring, int row, int column) {
  const auto K = [&](int i, int j) { return spring.K[static_cast<std::size_t>(6 * (row + i) + column + j)]; };
  Mat3<T> B;
  const bool plain = spring.shape != SpringShape::full;
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 3; ++i) {
    COUNTERFLEX_UNROLL
    for (int j = 0; j < 3; ++j) {
      const int k = (j + 1) % 3, l = (j + 2) % 3;
      if (plain && row == column)
        B(i, j) = A(i, j) * K(j, j);
      else if (plain)
        B(i, j) = A(i, k) * K(k, j) + A(i, l) * K(l, j);
      else
        B(i, j) = A(i, 0) * K(0, j) + A(i, 1) * K(1, j) + A(i, 2) * K(2, j);
    }
  }
  return B;
}

/// T' K T of an isotropic spring: N N' = 1 + b [phi]^2.
template <class T>
COUNTERFLEX_INLINE Sym6<T> isotropic_tangent(const Spring& spring, const ElementTerms<T>& terms) {
  const Vec3<T>& p = terms.p;
  const double k = spring.K[0] * spring.tangent_factor, k_turn = spring.K[21] * spring.tangent_factor;
  const T y = dot(terms.turn, terms.turn), c = jacobian_coefficient(y);
  const Vec3<T>&phi = terms.turn, bent = phi * (k_turn * (2 * c - 0.25 - c * c * y));
  const T diagonal = k_turn - dot(bent, phi) + k * dot(p, p);
  Sym6<T> K{};
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 3; ++i) {
    K(i, i) = all<T>(k);
    COUNTERFLEX_UNROLL
    for (int j = 0; j <= i; ++j) K(3 + i, 3 + j) = bent[i] * phi[j] - k * p[i] * p[j];
    K(3 + i, 3 + i) += diagonal;
  }
  K(3, 1) = p[2] * -k, K(3, 2) = p[1] * k;
  K(4, 0) = p[2] * k, K(4, 2) = p[0] * -k;
  K(5, 0) = p[1] * -k, K(5, 1) = p[0] * k;
  return K;
}

/// T' K T of any spring.
template <class T>
COUNTERFLEX_INLINE Sym6<T> general_tangent(const Spring& spring, const ElementTerms<T>& terms) {
  const Vec3<T>&p = terms.p, &phi = terms.turn;
  const T y = dot(phi, phi), c = jacobian_coefficient(y);
  Mat3<T> N;  // J_l^-T = 1 + [phi] / 2 + c [phi]^2
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 3; ++i) {
    COUNTERFLEX_UNROLL
    for (int j = 0; j < 3; ++j) N(i, j) = c * phi[i] * phi[j] + (i == j ? 1 - c * y : T{});
  }
  N(0, 1) -= 0.5 * phi[2], N(0, 2) += 0.5 * phi[1], N(1, 0) += 0.5 * phi[2];
  N(1, 2) -= 0.5 * phi[0], N(2, 0) -= 0.5 * phi[1], N(2, 1) += 0.5 * phi[0];
  const Mat3<T> Q = terms.R * N;
  const Mat3<T> vv = times_transposed(times_block(terms.R, spring, 0, 0), terms.R),
                ww = times_transposed(times_block(Q, spring, 3, 3), Q);
  Mat3<T> vw{};
  if (spring.shape != SpringShape::diagonal) vw = times_transposed(times_block(terms.R, spring, 0, 3), Q);
  // Strains of the position are R'(v - [p] w).
  Mat3<T> shifted = times_skew(vv, p);
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 9; ++i) shifted.c[i] = vw.c[i] - shifted.c[i];
  const Mat3<T> first = skew_times(p, shifted), second = skew_times(p, vw);
  Sym6<T> K;
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 3; ++i) {
    COUNTERFLEX_UNROLL
    for (int j = 0; j <= i; ++j) {
      K(i, j) = vv(i, j);
      K(3 + i, 3 + j) = ww(i, j) + first(i, j) + second(j, i);
    }
    COUNTERFLEX_UNROLL
    for (int j = 0; j < 3; ++j) K(3 + i, j) = shifted(j, i);
  }
  return K;
}

/// The tangent of a spring in the twist of its end less that of its start: T' K T + G(f, p).
template <class T>
COUNTERFLEX_INLINE Sym6<T> spring_tangent(const Spring& spring, const ElementTerms<T>& terms, bool stressed) {
  Sym6<T> K = spring.shape == SpringShape::isotropic ? isotropic_tangent(spring, terms)
                                                     : general_tangent(spring, terms);
  if (stressed) add_force_hessian(terms.stress.v, terms.p, K);
  return K;
}

template <class T>
struct Columns {
  Vec6<T> c[most_actuators_of_series];  ///< by slot of the series
};

/// Eliminates a joint beside an element whose tangent is K. `side`: -1 before the element, +1 behind it.
template <class T>
COUNTERFLEX_INLINE void eliminate_joint(const FrameStep& step, double side, const Element& element,
                                        Work<T>& work, const Vec6<T>& stress, int& eliminated, Sym6<T>& K,
                                        Columns<T>& columns) {
  const Vec6<T>& s = at(work.equations.joints, step.joint).s;
  Vec6<T> u = K * s;
  if (work.stressed) u = u + bracket_form(stress, s) * (0.5 * side);
  const int* slots = work.machine.slots.data() + element.slots;
  if (step.actuator >= 0) {
    columns.c[slots[eliminated++]] = u * -1.0;
    return;
  }
  T pivot = dot(s, u) + step.k;
  if (step.k_change != 0) {
    const T x = at(work.state.joints, step.joint).q - step.rest;
    pivot = dot(s, u) + joint_force(step.k, step.k_change, step.knee, x).stiffness;
  }
  JointFactor<T>& factor = at(work.factors.joints, step.joint);
  factor.inverse = select<T>(magnitude(pivot) > least_pivot, 1.0 / pivot, T{});
  factor.u = u * factor.inverse;
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 6; ++i) {
    COUNTERFLEX_UNROLL
    for (int j = 0; j <= i; ++j) K(i, j) -= factor.u[i] * u[j];
  }
  for (int i = 0; i < eliminated; ++i) {
    Vec6<T>& column = columns.c[slots[i]];
    const T x = dot(s, column);
    at(work.factors.couplings, step.coupling + i) = x * factor.inverse;
    column = column - factor.u * x;
  }
}

template <class T>
void factor_series(int s, Work<T>& work, Sym6<T>& K, Columns<T>& columns);

/// The tangent of an element with its joints, in the twist of its end frame less that of its start frame.
template <class T>
void factor_element(int id, Work<T>& work, Sym6<T>& K, Columns<T>& columns) {
  const FlatMachine& machine = work.machine;
  const Element& element = at(machine.elements, id);
  const ElementTerms<T>& terms = at(work.equations.elements, id);
  int eliminated = 0;
  if (element.kind == ElementKind::group) {
    K = {};
    for (int branch = 0; branch < element.branches; ++branch) {
      Sym6<T> of_branch;
      Columns<T> columns_of_branch;
      factor_series(element.series + branch, work, of_branch, columns_of_branch);
      K = K + of_branch;
      for (int i = 0; i < at(machine.series, element.series + branch).actuator_count; ++i)
        columns.c[at(machine.slots, element.slots + eliminated++)] = columns_of_branch.c[i];
    }
  } else {
    K = spring_tangent(at(machine.springs, element.spring), terms, work.stressed);
  }
  for (int i = element.front + element.fronts - 1; i >= element.front; --i)
    if (const FrameStep& step = at(machine.steps, i); step.is_joint())
      eliminate_joint(step, -1, element, work, terms.stress, eliminated, K, columns);
  for (int i = element.after + element.afters - 1; i >= element.after; --i)
    if (const FrameStep& step = at(machine.steps, i); step.is_joint())
      eliminate_joint(step, 1, element, work, terms.stress, eliminated, K, columns);
}

/// Adds half of Lambda, Lambda xi = h(xi), to a matrix of 36 numbers.
template <class T>
COUNTERFLEX_INLINE void add_half_bracket(const Vec6<T>& phi, T* Z) {
  const Vec3<T>&f = phi.v, &m = phi.w;
  const auto add_minus_half_skew = [&](int row, int column, const Vec3<T>& a) {
    T* B = Z + 6 * row + column;
    B[1] += 0.5 * a[2], B[2] -= 0.5 * a[1], B[6] -= 0.5 * a[2];
    B[8] += 0.5 * a[0], B[12] += 0.5 * a[1], B[13] -= 0.5 * a[0];
  };
  add_minus_half_skew(0, 3, f);
  add_minus_half_skew(3, 0, f);
  add_minus_half_skew(3, 3, m);
}

template <class T>
COUNTERFLEX_INLINE void add_weight_hessians(const Weights& weights, const Frame<T>& X, const Work<T>& work,
                                            Sym6<T>& K) {
  for (int i = weights.first; i < weights.first + weights.count; ++i) {
    const WeightTerms<T> terms = weight_terms(at(work.machine.weights, i), X, work);
    add_force_hessian(terms.f, terms.p, K);
  }
}

/// Eliminates the node between what is before it (tangent K) and an element (tangent Ke): K becomes that of
/// both.
template <class T>
COUNTERFLEX_INLINE void eliminate_node(int node, const Sym6<T>& Ke, const Vec6<T>& stress, Work<T>& work,
                                       Sym6<T>& K) {
  NodeFactor<T>& factor = at(work.factors.nodes, node);
  factor.L = K + Ke;
  if (work.stressed)
    add_weight_hessians(at(work.machine.weights_of_node, node), at(work.state.nodes, node), work, factor.L);
  factor_in_place(factor.L);
  T* Z = factor.W;
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 6; ++i) {
    COUNTERFLEX_UNROLL
    for (int j = 0; j < 6; ++j) Z[6 * i + j] = Ke(i, j);
  }
  if (work.stressed) add_half_bracket(stress, Z);
  COUNTERFLEX_UNROLL
  for (int j = 0; j < 6; ++j) {
    Vec6<T> z;
    COUNTERFLEX_UNROLL
    for (int i = 0; i < 6; ++i) z[i] = Z[6 * i + j];
    solve_lower(factor.L, z);
    COUNTERFLEX_UNROLL
    for (int i = 0; i < 6; ++i) Z[6 * i + j] = z[i];
  }
  K = Ke;
  COUNTERFLEX_UNROLL
  for (int k = 0; k < 6; ++k) {
    T scaled[6];
    COUNTERFLEX_UNROLL
    for (int i = 0; i < 6; ++i) scaled[i] = Z[6 * k + i] * factor.L(k, k);
    COUNTERFLEX_UNROLL
    for (int i = 0; i < 6; ++i) {
      COUNTERFLEX_UNROLL
      for (int j = 0; j <= i; ++j) K(i, j) -= scaled[i] * Z[6 * k + j];
    }
    COUNTERFLEX_UNROLL
    for (int i = 0; i < 6; ++i) Z[6 * k + i] = scaled[i];
  }
  COUNTERFLEX_UNROLL
  for (int j = 0; j < 6; ++j) {
    Vec6<T> z;
    COUNTERFLEX_UNROLL
    for (int i = 0; i < 6; ++i) z[i] = Z[6 * i + j];
    solve_upper(factor.L, z);
    COUNTERFLEX_UNROLL
    for (int i = 0; i < 6; ++i) Z[6 * i + j] = z[i];
  }
}

/// W' x
template <class T>
COUNTERFLEX_INLINE Vec6<T> back_through(const NodeFactor<T>& factor, const Vec6<T>& x) {
  Vec6<T> y;
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 6; ++i) {
    T sum = factor.W[i] * x[0];
    COUNTERFLEX_UNROLL
    for (int j = 1; j < 6; ++j) sum += factor.W[6 * j + i] * x[j];
    y[i] = sum;
  }
  return y;
}
/// W x
template <class T>
COUNTERFLEX_INLINE Vec6<T> forth_through(const NodeFactor<T>& factor, const Vec6<T>& x) {
  Vec6<T> y;
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 6; ++i) {
    T sum = factor.W[6 * i] * x[0];
    COUNTERFLEX_UNROLL
    for (int j = 1; j < 6; ++j) sum += factor.W[6 * i + j] * x[j];
    y[i] = sum;
  }
  return y;
}

template <class T>
void factor_series(int s, Work<T>& work, Sym6<T>& K, Columns<T>& columns) {
  const FlatMachine& machine = work.machine;
  const Series& series = at(machine.series, s);
  for (int a = 0; a < series.actuator_count; ++a) columns.c[a] = {};
  for (int k = 0; k < series.count; ++k) {
    const int id = series.first + k;
    Sym6<T> Ke;
    Columns<T> of_element;
    for (int a = 0; a < series.actuator_count; ++a) of_element.c[a] = {};
    factor_element(id, work, Ke, of_element);
    if (k == 0) {
      K = Ke;
      for (int a = 0; a < series.actuator_count; ++a) columns.c[a] = of_element.c[a];
      continue;
    }
    const int node = at(machine.elements, id - 1).node;
    eliminate_node(node, Ke, at(work.equations.elements, id).stress, work, K);
    const NodeFactor<T>& factor = at(work.factors.nodes, node);
    for (int a = 0; a < series.actuator_count; ++a) {
      Vec6<T>& y = at(work.factors.node_columns, node * machine.most_actuators + a);
      y = columns.c[a] - of_element.c[a];
      columns.c[a] = of_element.c[a] + back_through(factor, y);
      solve_factored(factor.L, y);
    }
  }
}

/// Solves the platform's equations. The moment of the load keeps its direction, so it has no potential: the
/// second derivative of energy lacks half of its bracket, K xi + (0, w x m) / 2. It is small beside K: one
/// correction does for it.
template <class T>
COUNTERFLEX_INLINE void solve_platform(const Work<T>& work, Vec6<T>& x) {
  solve_factored(work.factors.L, x);
  if (work.question.load == 0) return;
  Vec6<T> correction{{}, cross(x.w, work.load.w) * (0.5 * work.question.load)};
  solve_factored(work.factors.L, correction);
  x = x - correction;
}

/// Factors the tangent at the state that was evaluated last, with the stress that the elements have.
template <class T>
void factor(Work<T>& work) {
  const FlatMachine& machine = work.machine;
  Factors<T>& factors = work.factors;
  factors.K = {};
  if (work.stressed) {
    const Vec3<T> f = work.load.v * -work.question.load;
    add_force_hessian(f, arm_of_load(work), factors.K);
    for (int s = 0; s < machine.chains; ++s)
      add_weight_hessians(at(machine.series, s).at_end, work.state.platform, work, factors.K);
  }
  for (int s = 0; s < machine.chains; ++s) {
    Sym6<T> K;
    Columns<T> columns;
    factor_series(s, work, K, columns);
    factors.K = factors.K + K;
    const Series& series = at(machine.series, s);
    for (int a = 0; a < series.actuator_count; ++a)
      at(factors.actuators, at(machine.actuators, series.actuators + a)) = columns.c[a];
  }
  factors.L = factors.K;
  factor_in_place(factors.L);
  if (!work.moves_actuators) return;
  for (std::size_t a = 0; a < factors.actuators.size(); ++a) {
    factors.responses[a] = factors.actuators[a];
    solve_platform(work, factors.responses[a]);
  }
}

}  // namespace counterflex::kernel
