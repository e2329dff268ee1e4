#pragma once
/// Vectors, rotations, frames, twists and wrenches of the kernel. Twists (v, w) and wrenches (f, m) are about
/// one common point, axes of M.
#include "statics/kernel/equations/numbers.hpp"

namespace counterflex::kernel {

template <class T>
struct Vec3 {
  T c[3];
  COUNTERFLEX_INLINE T& operator[](int i) { return c[i]; }
  COUNTERFLEX_INLINE const T& operator[](int i) const { return c[i]; }
};

template <class T>
COUNTERFLEX_INLINE Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) {
  return {{a[0] + b[0], a[1] + b[1], a[2] + b[2]}};
}
template <class T>
COUNTERFLEX_INLINE Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) {
  return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}};
}
template <class T, class Factor>
COUNTERFLEX_INLINE Vec3<T> operator*(const Vec3<T>& a, const Factor& s) {
  return {{a[0] * s, a[1] * s, a[2] * s}};
}
template <class T>
COUNTERFLEX_INLINE T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class T>
COUNTERFLEX_INLINE Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

/// A twist (v, w) or a wrench (f, m).
template <class T>
struct Vec6 {
  Vec3<T> v, w;
  COUNTERFLEX_INLINE T& operator[](int i) { return i < 3 ? v.c[i] : w.c[i - 3]; }
  COUNTERFLEX_INLINE const T& operator[](int i) const { return i < 3 ? v.c[i] : w.c[i - 3]; }
};

template <class T>
COUNTERFLEX_INLINE Vec6<T> operator+(const Vec6<T>& a, const Vec6<T>& b) {
  return {a.v + b.v, a.w + b.w};
}
template <class T>
COUNTERFLEX_INLINE Vec6<T> operator-(const Vec6<T>& a, const Vec6<T>& b) {
  return {a.v - b.v, a.w - b.w};
}
template <class T, class Factor>
COUNTERFLEX_INLINE Vec6<T> operator*(const Vec6<T>& a, const Factor& s) {
  return {a.v * s, a.w * s};
}
template <class T>
COUNTERFLEX_INLINE T dot(const Vec6<T>& a, const Vec6<T>& b) {
  return dot(a.v, b.v) + dot(a.w, b.w);
}

/// A 3 x 3 matrix, row by row.
template <class T>
struct Mat3 {
  T c[9];
  COUNTERFLEX_INLINE T& operator()(int i, int j) { return c[3 * i + j]; }
  COUNTERFLEX_INLINE const T& operator()(int i, int j) const { return c[3 * i + j]; }
};

template <class T>
COUNTERFLEX_INLINE Vec3<T> operator*(const Mat3<T>& A, const Vec3<T>& x) {
  Vec3<T> y;
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 3; ++i) y[i] = A(i, 0) * x[0] + A(i, 1) * x[1] + A(i, 2) * x[2];
  return y;
}
/// A' x
template <class T>
COUNTERFLEX_INLINE Vec3<T> transposed_times(const Mat3<T>& A, const Vec3<T>& x) {
  Vec3<T> y;
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 3; ++i) y[i] = A(0, i) * x[0] + A(1, i) * x[1] + A(2, i) * x[2];
  return y;
}
template <class T>
COUNTERFLEX_INLINE Mat3<T> operator*(const Mat3<T>& A, const Mat3<T>& B) {
  Mat3<T> C;
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 3; ++i) {
    COUNTERFLEX_UNROLL
    for (int j = 0; j < 3; ++j) C(i, j) = A(i, 0) * B(0, j) + A(i, 1) * B(1, j) + A(i, 2) * B(2, j);
  }
  return C;
}
/// A' B
template <class T>
COUNTERFLEX_INLINE Mat3<T> transposed_times(const Mat3<T>& A, const Mat3<T>& B) {
  Mat3<T> C;
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 3; ++i) {
    COUNTERFLEX_UNROLL
    for (int j = 0; j < 3; ++j) C(i, j) = A(0, i) * B(0, j) + A(1, i) * B(1, j) + A(2, i) * B(2, j);
  }
  return C;
}
/// A B'
template <class T>
COUNTERFLEX_INLINE Mat3<T> times_transposed(const Mat3<T>& A, const Mat3<T>& B) {
  Mat3<T> C;
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 3; ++i) {
    COUNTERFLEX_UNROLL
    for (int j = 0; j < 3; ++j) C(i, j) = A(i, 0) * B(j, 0) + A(i, 1) * B(j, 1) + A(i, 2) * B(j, 2);
  }
  return C;
}

/// A pose in M: rotation, and the place of the origin from the common point.
template <class T>
struct Frame {
  Mat3<T> R;
  Vec3<T> p;
};

/// Turns of more than this in one step are shortened to it (rad): the series of `exp_so3` holds to it.
inline constexpr double largest_turn = 0.5;
/// Up to this turn (rad) `log_so3` is good to the last digit.
inline constexpr double largest_spring_turn = 0.2;

/// c[0] + c[1] y + ...: neighbours in pairs, and those in pairs, for short chains of operations.
template <int count, class T>
COUNTERFLEX_INLINE T polynomial(const double* c, const T& y) {
  if constexpr (count == 1) {
    return all<T>(c[0]);
  } else if constexpr (count == 2) {
    return c[0] + c[1] * y;
  } else {
    constexpr int half = count > 8 ? 8 : count > 4 ? 4 : 2;
    T power = y * y;
    for (int i = 2; i < half; i *= 2) power = power * power;
    return polynomial<half>(c, y) + power * polynomial<count - half>(c + half, y);
  }
}

/// sin x / x, (1 - cos x) / x^2, arcsin x / x, y = x^2
template <class T>
COUNTERFLEX_INLINE T sine_series(const T& y) {
  constexpr double c[]{1, -1. / 6, 1. / 120, -1. / 5040, 1. / 362880, -1. / 39916800, 1. / 6227020800};
  return polynomial<7>(c, y);
}
template <class T>
COUNTERFLEX_INLINE T versine_series(const T& y) {
  constexpr double c[]{1. / 2,       -1. / 24,        1. / 720,        -1. / 40320,
                       1. / 3628800, -1. / 479001600, 1. / 87178291200};
  return polynomial<7>(c, y);
}
template <class T>
COUNTERFLEX_INLINE T arcsine_series(const T& y) {
  constexpr double c[]{1,          1. / 6,       3. / 40,      5. / 112,       35. / 1152,
                       63. / 2816, 231. / 13312, 143. / 10240, 6435. / 557056, 12155. / 1245184};
  return polynomial<10>(c, y);
}

/// Exp(w) for a w of at most `largest_turn`.
template <class T>
COUNTERFLEX_INLINE Mat3<T> exp_so3(const Vec3<T>& w) {
  const T y = dot(w, w), a = sine_series(y), b = versine_series(y);
  Mat3<T> E;
  E(0, 0) = 1 - b * (w[1] * w[1] + w[2] * w[2]);
  E(1, 1) = 1 - b * (w[0] * w[0] + w[2] * w[2]);
  E(2, 2) = 1 - b * (w[0] * w[0] + w[1] * w[1]);
  E(0, 1) = b * w[0] * w[1] - a * w[2];
  E(1, 0) = b * w[0] * w[1] + a * w[2];
  E(0, 2) = b * w[0] * w[2] + a * w[1];
  E(2, 0) = b * w[0] * w[2] - a * w[1];
  E(1, 2) = b * w[1] * w[2] - a * w[0];
  E(2, 1) = b * w[1] * w[2] + a * w[0];
  return E;
}

/// Log R from its antisymmetric part, by the series of the arcsine: right for turns of at most
/// `largest_spring_turn`, and too short beyond.
template <class T>
COUNTERFLEX_INLINE Vec3<T> log_so3(const Mat3<T>& R) {
  const Vec3<T> a{{0.5 * (R(2, 1) - R(1, 2)), 0.5 * (R(0, 2) - R(2, 0)), 0.5 * (R(1, 0) - R(0, 1))}};
  return a * arcsine_series(dot(a, a));
}

/// h(s) with phi.[xi, s] = h(s).xi for the bracket of twists.
template <class T>
COUNTERFLEX_INLINE Vec6<T> bracket_form(const Vec6<T>& phi, const Vec6<T>& s) {
  return {cross(s.w, phi.v), cross(s.v, phi.v) + cross(s.w, phi.w)};
}

/// A symmetric 6 x 6 matrix: its lower triangle, row by row.
template <class T>
struct Sym6 {
  T c[21];
  static constexpr int at(int i, int j) { return i >= j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i; }
  COUNTERFLEX_INLINE T& operator()(int i, int j) { return c[at(i, j)]; }
  COUNTERFLEX_INLINE const T& operator()(int i, int j) const { return c[at(i, j)]; }
};

template <class T>
COUNTERFLEX_INLINE Sym6<T> operator+(const Sym6<T>& A, const Sym6<T>& B) {
  Sym6<T> C;
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 21; ++i) C.c[i] = A.c[i] + B.c[i];
  return C;
}
template <class T>
COUNTERFLEX_INLINE Vec6<T> operator*(const Sym6<T>& A, const Vec6<T>& x) {
  Vec6<T> y;
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 6; ++i) {
    T sum = A(i, 0) * x[0];
    COUNTERFLEX_UNROLL
    for (int j = 1; j < 6; ++j) sum += A(i, j) * x[j];
    y[i] = sum;
  }
  return y;
}

/// Adds the second derivative of a constant force's energy -f.x at the point p; `f` is the gradient, so minus
/// the force.
template <class T>
COUNTERFLEX_INLINE void add_force_hessian(const Vec3<T>& f, const Vec3<T>& p, Sym6<T>& K) {
  const T pf = dot(p, f);
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 3; ++i) {
    COUNTERFLEX_UNROLL
    for (int j = 0; j <= i; ++j) {
      K(3 + i, 3 + j) += 0.5 * (p[i] * f[j] + p[j] * f[i]);
      if (i == j) K(3 + i, 3 + j) -= pf;
    }
  }
  K(4, 0) -= 0.5 * f[2];
  K(5, 0) += 0.5 * f[1];
  K(3, 1) += 0.5 * f[2];
  K(5, 1) -= 0.5 * f[0];
  K(3, 2) -= 0.5 * f[1];
  K(4, 2) += 0.5 * f[0];
}

/// L D L' in the place of A, the inverses of D on its diagonal.
template <class T>
COUNTERFLEX_INLINE void factor_in_place(Sym6<T>& A) {
  COUNTERFLEX_UNROLL
  for (int k = 0; k < 6; ++k) {
    const T inverse = 1.0 / A(k, k);
    A(k, k) = inverse;
    T l[6];
    COUNTERFLEX_UNROLL
    for (int i = k + 1; i < 6; ++i) l[i] = A(i, k) * inverse;
    COUNTERFLEX_UNROLL
    for (int i = k + 1; i < 6; ++i) {
      COUNTERFLEX_UNROLL
      for (int j = k + 1; j <= i; ++j) A(i, j) -= l[i] * A(j, k);
    }
    COUNTERFLEX_UNROLL
    for (int i = k + 1; i < 6; ++i) A(i, k) = l[i];
  }
}

/// x = L^-1 x
template <class T>
COUNTERFLEX_INLINE void solve_lower(const Sym6<T>& L, Vec6<T>& x) {
  COUNTERFLEX_UNROLL
  for (int i = 1; i < 6; ++i) {
    COUNTERFLEX_UNROLL
    for (int j = 0; j < i; ++j) x[i] -= L(i, j) * x[j];
  }
}
/// x = L'^-1 x
template <class T>
COUNTERFLEX_INLINE void solve_upper(const Sym6<T>& L, Vec6<T>& x) {
  COUNTERFLEX_UNROLL
  for (int i = 4; i >= 0; --i) {
    COUNTERFLEX_UNROLL
    for (int j = i + 1; j < 6; ++j) x[i] -= L(j, i) * x[j];
  }
}
template <class T>
COUNTERFLEX_INLINE void scale_by_diagonal(const Sym6<T>& L, Vec6<T>& x) {
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 6; ++i) x[i] = x[i] * L(i, i);
}
/// x = (L D L')^-1 x
template <class T>
COUNTERFLEX_INLINE void solve_factored(const Sym6<T>& L, Vec6<T>& x) {
  solve_lower(L, x);
  scale_by_diagonal(L, x);
  solve_upper(L, x);
}

}  // namespace counterflex::kernel
