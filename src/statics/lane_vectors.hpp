#pragma once
/// Vectors of W doubles, a lane each, and what is done with them: three-vectors, rotations (row-major), polynomials, and products
/// with matrices that are the same for all lanes.
#include "lane_program.hpp"

namespace counterflex::lanes {

template <int W>
struct VectorOf {
  typedef double Real __attribute__((vector_size(W * sizeof(double))));
  typedef long long Mask __attribute__((vector_size(W * sizeof(double))));
};

template <int W>
struct LaneVectors {
  using V = typename VectorOf<W>::Real;
  using M = typename VectorOf<W>::Mask;

  static V broadcast(double x) { return V{} + x; }
  static V select(M mask, V yes, V no) { return mask ? yes : no; }
  static V larger(V a, V b) { return a > b ? a : b; }
  static V magnitude(V a) { return larger(a, -a); }
  static bool any(M mask) {
    long long all = 0;
    for (int i = 0; i < W; ++i) all |= mask[i];
    return all != 0;
  }
  static V root(V a) {
    V b{};
    for (int i = 0; i < W; ++i) b[i] = __builtin_sqrt(a[i]);
    return b;
  }
  static V dot(const V* a, const V* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
  static void cross(const V* a, const V* b, V* c) {
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
  }
  /// R' a
  static void into(const V* R, const V* a, V* b) {
    for (int i = 0; i < 3; ++i) b[i] = R[i] * a[0] + R[3 + i] * a[1] + R[6 + i] * a[2];
  }
  static void rotate(const V* R, const V* a, V* b) {
    for (int i = 0; i < 3; ++i) b[i] = R[3 * i] * a[0] + R[3 * i + 1] * a[1] + R[3 * i + 2] * a[2];
  }
  static void multiply(const V* A, const V* B, V* C) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        C[3 * i + j] = A[3 * i] * B[j] + A[3 * i + 1] * B[3 + j] + A[3 * i + 2] * B[6 + j];
  }

  /// N rows of a product: as many sums at once, so that none waits for its own last addition.
  template <int N, bool add>
  static void product_rows(const double* A, int columns, const V* x, V* y) {
    V sum[N];
#pragma GCC unroll 8
    for (int r = 0; r < N; ++r) sum[r] = add ? y[r] : A[r * columns] * x[0];
    for (int k = add ? 0 : 1; k < columns; ++k) {
      const V xk = x[k];
#pragma GCC unroll 8
      for (int r = 0; r < N; ++r) sum[r] += A[r * columns + k] * xk;
    }
#pragma GCC unroll 8
    for (int r = 0; r < N; ++r) y[r] = sum[r];
  }

  /// y = A x and y += A x, A row-major and the same for all lanes; it has columns.
  static void product(const double* A, int rows, int columns, const V* x, V* y) { any_product<false>(A, rows, columns, x, y); }
  static void add_product(const double* A, int rows, int columns, const V* x, V* y) { any_product<true>(A, rows, columns, x, y); }

  template <bool add>
  static void any_product(const double* A, int rows, int columns, const V* x, V* y) {
    int r = 0;
    for (; rows - r >= 8; r += 8) product_rows<8, add>(A + r * columns, columns, x, y + r);
    switch (rows - r) {
      case 7: return product_rows<7, add>(A + r * columns, columns, x, y + r);
      case 6: return product_rows<6, add>(A + r * columns, columns, x, y + r);
      case 5: return product_rows<5, add>(A + r * columns, columns, x, y + r);
      case 4: return product_rows<4, add>(A + r * columns, columns, x, y + r);
      case 3: return product_rows<3, add>(A + r * columns, columns, x, y + r);
      case 2: return product_rows<2, add>(A + r * columns, columns, x, y + r);
      case 1: return product_rows<1, add>(A + r * columns, columns, x, y + r);
    }
  }

  /// sin t / t, (1 - cos t) / t^2, (t - sin t) / t^3 for t^2 = t2 up to 0.25^2.
  static void exp_coefficients(V t2, V& a, V& b, V& c) {
    a = 1 - t2 * (1.0 / 6) * (1 - t2 * (1.0 / 20) * (1 - t2 * (1.0 / 42) * (1 - t2 * (1.0 / 72) * (1 - t2 * (1.0 / 110)))));
    b = 0.5 - t2 * (1.0 / 24) * (1 - t2 * (1.0 / 30) * (1 - t2 * (1.0 / 56) * (1 - t2 * (1.0 / 90) * (1 - t2 * (1.0 / 132)))));
    c = 1.0 / 6 - t2 * (1.0 / 120) * (1 - t2 * (1.0 / 42) * (1 - t2 * (1.0 / 72) * (1 - t2 * (1.0 / 110))));
  }

  /// Polynomials by Horner's rule; coefficients stand from the highest powers down, all of one power after another.
  static void evaluate_polynomials(int count, int degree, const double* c, const V* x, V* out) {
    int a = 0;
    for (; a + 3 <= count; a += 3) evaluate_some<3>(degree, c + a, count, x, out + a);
    for (; a < count; ++a) evaluate_some<1>(degree, c + a, count, x, out + a);
  }

  template <int N>
  static void evaluate_some(int degree, const double* c, int stride, const V* x, V* out) {
    V sum_x[N]{}, sum_y[N], sum_z[N];
    for (int i = 0; i <= degree; ++i) {
      for (V& sum : sum_y) sum = V{};
      for (int j = 0; j <= i; ++j) {
        for (V& sum : sum_z) sum = V{};
        for (int k = 0; k <= j; ++k, c += stride)
          for (int o = 0; o < N; ++o) sum_z[o] = sum_z[o] * x[2] + c[o];
        for (int o = 0; o < N; ++o) sum_y[o] = sum_y[o] * x[1] + sum_z[o];
      }
      for (int o = 0; o < N; ++o) sum_x[o] = sum_x[o] * x[0] + sum_y[o];
    }
    for (int o = 0; o < N; ++o) out[o] = sum_x[o];
  }

  /// All powers together up to the degree, in the order of `evaluate_polynomials`.
  static int find_monomials(int degree, const V* x, V* powers) {
    V of[3][most_displacement_degree + 1];
    for (int i = 0; i < 3; ++i) {
      of[i][0] = broadcast(1);
      for (int d = 1; d <= degree; ++d) of[i][d] = of[i][d - 1] * x[i];
    }
    int count = 0;
    for (int i = 0; i <= degree; ++i)
      for (int j = 0; j <= i; ++j) {
        const V xy = of[0][degree - i] * of[1][i - j];
        for (int k = 0; k <= j; ++k) powers[count++] = xy * of[2][j - k];
      }
    return count;
  }
};

}  // namespace counterflex::lanes
