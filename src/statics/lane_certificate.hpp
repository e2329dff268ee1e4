#pragma once
/// The proof of stability of EQUATIONS.md, section 7, for the lanes that a kernel has just solved. It can only say yes,
/// and says nothing of machines with weights.
#include "lane_kernel.hpp"

namespace counterflex::lanes {

template <int W>
class LaneCertificate {
  using Kernel = LaneKernel<W>;
  using Vectors = LaneVectors<W>;
  using V = typename Vectors::V;
  using M = typename Vectors::M;

  static constexpr double smallest_diagonal = 1e-7, largest_penalty = 1e4, margin = 1e-7, smallest_pivot = 1e-13;

 public:
  /// After `Kernel::solve` with the same arguments. `scratch` holds `doubles_of_certificate` numbers, aligned to 64 bytes.
  static void judge(const Program& program, const Region& region, const Question& question, const Batch& batch, double* memory,
                    double* scratch, bool* stable) {
    for (int first = 0; first < width; first += W) {
      Kernel kernel(program, region, question, memory, first);
      LaneCertificate certificate(program, kernel, scratch);
      const M yes = certificate.is_stable(batch, first);
      for (int lane = 0; lane < W; ++lane) stable[first + lane] = batch.converged[first + lane] && yes[lane] != 0;
    }
  }

 private:
  LaneCertificate(const Program& program, Kernel& kernel, double* scratch) : program_(program), kernel_(kernel) {
    least_ = reinterpret_cast<V*>(scratch);
    v_ = least_ + 36L * program.series_count;
    w_ = v_ + 3L * program.most_free;
    J_ = w_ + 3L * program.most_free;
    Y_ = J_ + 6L * program.most_free;
    A_ = Y_ + 6L * program.most_free;
  }

  M is_stable(const Batch& batch, int first) {
    ok_ = (V{} == V{});
    for (int s = 0; s < program_.series_count; ++s) {
      if (program_.series[s].rows == 6 || program_.series[s].mass > 0) return ok_ & ~ok_;  // a rigid bar, weights
      take_least_energy(program_.series[s], least_ + 36L * s);
    }
    V K[36]{};
    for (int s = 0; s < program_.series_count; ++s)
      if (program_.series[s].is_chain)
        for (int i = 0; i < 36; ++i) K[i] += least_[36L * s + i];
    subtract_load(batch, first, K);
    V largest{};
    for (const V& x : K) largest = Vectors::larger(largest, Vectors::magnitude(x));
    for (int i = 0; i < 6; ++i) K[7 * i] -= margin * largest;
    factor(K, 6, 0);
    return ok_;
  }

  double energy() const { return 1e6 * program_.length * program_.length; }

  // Symmetric part of the load's tangent (f r' - (f.r) I, over the platform's turn).
  void subtract_load(const Batch& batch, int first, V* K) {
    V arm[3], r[3];
    const V* f = kernel_.F_;
    for (int i = 0; i < 3; ++i) arm[i] = Vectors::broadcast(program_.arm[i]);
    Vectors::rotate(kernel_.state_ + program_.platform, arm, r);
    for (int i = 0; i < 3; ++i)
      for (int lane = 0; lane < W; ++lane) kernel_.F_[i][lane] = batch.F[i][first + lane];
    const V along = Vectors::dot(f, r);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        K[6 * (3 + i) + 3 + j] -= (0.5 * (r[i] * f[j] + r[j] * f[i]) - (i == j ? along : V{})) * (1 / energy());
  }

  // The least energy by the end's twist, if the inside is positive definite with the end held.
  //     A + rho J'J > 0  =>  A > 0 on the null space of J;      K = (J (A + rho J'J)^-1 J')^-1 - rho
  void take_least_energy(const Series& series, V* least) {
    const int n = series.rows - 6;
    place_columns(series);
    set_hessian(series, n);
    add_energy(series, n);
    in_units(series, n);
    add_branches(series, n);
    const V rho = penalise(n);
    factor(A_, n, 0);
    for (int r = 0; r < 6; ++r) solve_lower(A_, n, J_ + r, Y_ + r, 6);
    V C[36], Z[36], columns[36];
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j <= i; ++j) {
        V sum{};
        for (int k = 0; k < n; ++k) sum += Y_[6 * k + i] * Y_[6 * k + j];
        C[6 * i + j] = sum;
      }
    factor(C, 6, smallest_diagonal);
    for (int i = 0; i < 36; ++i) columns[i] = Vectors::broadcast(i % 7 == 0 ? 1 : 0);
    for (int r = 0; r < 6; ++r) solve_lower(C, 6, columns + r, Z + r, 6);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        V sum{};
        for (int k = 0; k < 6; ++k) sum += Z[6 * k + i] * Z[6 * k + j];
        least[6 * i + j] = i == j ? sum - rho : sum;
      }
  }

  void put_column(int c, const V* v, const V* w) {
    for (int i = 0; i < 3; ++i) v_[3 * c + i] = v[i];
    for (int i = 0; i < 3; ++i) w_[3 * c + i] = w[i];
  }

  void put_turn(int c, const V* w, const V* r) {
    V v[3];
    Vectors::cross(w, r, v);
    put_column(c, v, w);
  }

  // Twist of the end by every free coordinate.
  void place_columns(const Series& series) {
    kernel_.place(series, end_);
    const V none[3]{};
    for (int k = 0; k < series.part_count; ++k) {
      const Part& part = series.parts[k];
      if (part.row < 0) continue;
      const auto& at = kernel_.frames_[k];
      const int c = part.row - 6;
      V r[3];
      for (int i = 0; i < 3; ++i) r[i] = end_.p[i] - at.o[i];
      if (part.operation == Operation::slide) put_column(c, at.R, none);
      if (part.operation == Operation::turn) put_turn(c, at.R, r);
      if (part.operation == Operation::spring || part.operation == Operation::group) place_six(part, at.R, r);
    }
  }

  void place_six(const Part& part, const V* R, const V* r) {
    V axes[9];
    if (part.operation == Operation::spring)
      left_jacobian(kernel_.state_ + part.value + 3, axes);
    else
      for (int i = 0; i < 9; ++i) axes[i] = Vectors::broadcast(i % 4 == 0 ? 1 : 0);
    V turned[9];
    Vectors::multiply(R, axes, turned);
    const V none[3]{};
    for (int i = 0; i < 3; ++i) {
      const V v[3] = {R[i], R[3 + i], R[6 + i]}, w[3] = {turned[i], turned[3 + i], turned[6 + i]};
      put_column(part.row - 6 + i, v, none);
      put_turn(part.row - 3 + i, w, r);
    }
  }

  // J_l = I + b [phi] + c [phi]^2
  static void left_jacobian(const V* phi, V* J) {
    V a, b, c;
    const V t2 = Vectors::dot(phi, phi);
    Vectors::exp_coefficients(t2, a, b, c);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) J[3 * i + j] = c * phi[i] * phi[j] + (i == j ? 1 - c * t2 : V{});
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      J[3 * j + i] += b * phi[k];
      J[3 * i + j] -= b * phi[k];
    }
  }

  //     H_jk = v_j . (f x w_k) + w_j . (m x w_k),  H_kj = v_j . (f x w_k)      k before j; of both, the mean
  void set_hessian(const Series& series, int n) {
    const V *f = kernel_.state_ + series.wrench, *m = f + 3;
    for (int k = 0; k < n; ++k) {
      V f_x_w[3], m_x_w[3];
      Vectors::cross(f, w_ + 3 * k, f_x_w);
      Vectors::cross(m, w_ + 3 * k, m_x_w);
      for (int j = k; j < n; ++j)
        A_[j * n + k] = -Vectors::dot(v_ + 3 * j, f_x_w) - 0.5 * Vectors::dot(w_ + 3 * j, m_x_w);
    }
    for (int k = 0; k < series.part_count; ++k) {
      const Part& part = series.parts[k];
      if (part.operation == Operation::spring || part.operation == Operation::group) set_triple(part, k, f, m, n);
    }
  }

  // Three rotations about one point.
  void set_triple(const Part& part, int number, const V* f, const V* m, int n) {
    const auto& at = kernel_.frames_[number];
    const int c = part.row - 3;
    for (int k = 0; k < 3; ++k) {
      V f_x_w[3];
      Vectors::cross(f, w_ + 3 * (c + k), f_x_w);
      for (int j = 0; j < 3; ++j) {
        const V half = 0.5 * Vectors::dot(v_ + 3 * (c + j), f_x_w);
        V& entry = A_[(c + (j > k ? j : k)) * n + c + (j > k ? k : j)];
        if (j == k)
          entry = -2 * half;
        else
          entry = (j > k ? V{} : entry) - half;  // j > k comes first
      }
    }
    if (part.operation != Operation::spring) return;
    V r[3], M_o[3], M_before[3], D[9];
    for (int i = 0; i < 3; ++i) r[i] = end_.p[i] - at.o[i];
    Vectors::cross(r, f, M_o);
    for (int i = 0; i < 3; ++i) M_o[i] += m[i];
    Vectors::into(at.R, M_o, M_before);
    bend_of_jacobian(kernel_.state_ + part.value + 3, M_before, D);
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k <= j; ++k) A_[(c + j) * n + c + k] -= 0.5 * (D[3 * j + k] + D[3 * k + j]);
  }

  // Column k: (dJ_l / dphi_k)' M.
  static void bend_of_jacobian(const V* phi, const V* moment, V* D) {
    const V t2 = Vectors::dot(phi, phi);
    V a, b, c, turned[3], twice[3];
    Vectors::exp_coefficients(t2, a, b, c);
    const V db = 2 * (-1.0 / 24 + t2 * (1.0 / 360 - t2 * (1.0 / 13440 - t2 * (1.0 / 907200))));
    const V dc = 2 * (-1.0 / 120 + t2 * (1.0 / 2520 - t2 * (1.0 / 120960 - t2 * (1.0 / 9979200))));
    Vectors::cross(phi, moment, turned);
    Vectors::cross(phi, turned, twice);
    for (int k = 0; k < 3; ++k) {
      V unit[3]{}, one[3], two[3], three[3];
      unit[k] += 1;
      Vectors::cross(unit, moment, one);
      Vectors::cross(phi, one, two);
      Vectors::cross(unit, turned, three);
      for (int i = 0; i < 3; ++i)
        D[3 * i + k] = phi[k] * (dc * twice[i] - db * turned[i]) - b * one[i] + c * (two[i] + three[i]);
    }
  }

  void add_energy(const Series& series, int n) {
    for (int k = 0; k < series.part_count; ++k) {
      const Part& part = series.parts[k];
      if (part.row < 0) continue;
      const int c = part.row - 6;
      if (part.operation == Operation::slide || part.operation == Operation::turn) A_[c * n + c] += part.k;
      if (part.operation != Operation::spring) continue;
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j <= i; ++j) A_[(c + i) * n + c + j] += 0.5 * (part.K[6 * i + j] + part.K[6 * j + i]);
    }
  }

  void in_units(const Series& series, int n) {
    const double l = program_.length;
    const auto unit = [&](int c) { return series.angular[c] ? 1.0 : l; };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j <= i; ++j) A_[i * n + j] *= unit(i) * unit(j) / energy();
      for (int r = 0; r < 3; ++r) J_[6 * i + r] = v_[3 * i + r] * (unit(i) / l);
      for (int r = 0; r < 3; ++r) J_[6 * i + 3 + r] = w_[3 * i + r] * unit(i);
    }
  }

  void add_branches(const Series& series, int n) {
    for (int k = 0; k < series.part_count; ++k) {
      const Part& part = series.parts[k];
      if (part.operation != Operation::group) continue;
      const int c = part.row - 6;
      for (int b = 0; b < part.branches; ++b)
        for (int i = 0; i < 6; ++i)
          for (int j = 0; j <= i; ++j) A_[(c + i) * n + c + j] += least_[36L * (part.first_branch + b) + 6 * i + j];
    }
  }

  // Adds rho J'J and tells rho; beyond its limit the difference that makes K loses its digits.
  V penalise(int n) {
    V rho{};
    for (int i = 0; i < n; ++i)
      for (int j = 0; j <= i; ++j) rho = Vectors::larger(rho, Vectors::magnitude(A_[i * n + j]));
    rho = Vectors::larger(Vectors::broadcast(1), 10 * rho);
    ok_ &= rho <= largest_penalty;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j <= i; ++j) {
        V sum{};
        for (int r = 0; r < 6; ++r) sum += J_[6 * i + r] * J_[6 * j + r];
        A_[i * n + j] += rho * sum;
      }
    return rho;
  }

  // Cholesky's factor in the lower half, its diagonal inverted; a lane whose pivots are not positive, by more than the
  // rounding of the diagonal before elimination, is not ok.
  void factor(V* A, int n, double smallest) {
    for (int i = 0; i < n; ++i)
      for (int j = 0; j <= i; ++j) {
        V sum = A[i * n + j];
        const V before = sum;
        for (int k = 0; k < j; ++k) sum -= A[i * n + k] * A[j * n + k];
        if (j < i) {
          A[i * n + j] = sum * A[j * n + j];
          continue;
        }
        const M positive = (sum > smallest * smallest) & (sum > smallest_pivot * before);
        ok_ &= positive;
        A[i * n + i] = 1 / Vectors::root(Vectors::select(positive, sum, Vectors::broadcast(1)));
      }
  }

  // L y = x; entries of x and y stand `stride` apart.
  static void solve_lower(const V* L, int n, const V* x, V* y, int stride) {
    for (int i = 0; i < n; ++i) {
      V sum = x[i * stride];
      for (int k = 0; k < i; ++k) sum -= L[i * n + k] * y[k * stride];
      y[i * stride] = sum * L[i * n + i];
    }
  }

  const Program& program_;
  Kernel& kernel_;
  typename Kernel::Frame end_{};
  V *least_, *v_, *w_, *J_, *Y_, *A_;
  M ok_{};
};

}  // namespace counterflex::lanes
