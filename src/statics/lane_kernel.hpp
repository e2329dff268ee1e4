#pragma once
/// The kernel behind lane_program.hpp for vectors of W doubles. Lanes never meet: each is solved as if it were alone, with
/// the same operations in the same order for every W, so that results do not depend on the instruction set.
#include "lane_program.hpp"

namespace counterflex::lanes {

template <int W>
struct VectorOf {
  typedef double Real __attribute__((vector_size(W * sizeof(double))));
  typedef long long Mask __attribute__((vector_size(W * sizeof(double))));
};

template <int W>
class LaneKernel {
  template <int>
  friend class LaneCertificate;
  using V = typename VectorOf<W>::Real;
  using M = typename VectorOf<W>::Mask;

  static constexpr double closure_limit = 1e-12, step_limit = 1e-11, largest_angle = 0.25;
  static constexpr double kinematic_step_limit = 1e-13;
  static constexpr int most_iterations = 16;

  struct Frame {
    V R[9], p[3];
  };

  /// Where a part acts: its axes before, and the point about which it turns.
  struct PartFrame {
    V R[9], o[3];
  };

 public:
  static void solve(const Program& program, const Region& region, const Question& question, Batch& batch, double* memory) {
    for (int first = 0; first < width; first += W) {
      LaneKernel kernel(program, region, question, memory, first);
      kernel.run(batch);
    }
  }

 private:
  LaneKernel(const Program& program, const Region& region, const Question& question, double* memory, int first)
      : program_(program), region_(region), question_(question), first_(first) {
    // State of all lanes first (it survives), then what one call uses.
    state_ = reinterpret_cast<V*>(memory) + static_cast<long>(first / W) * program.states;
    V* rest = reinterpret_cast<V*>(memory + static_cast<long>(width) * program.states);
    rhs_ = rest;
    step_ = rhs_ + program.rows;
    rho_ = step_ + program.rows;
    drho_ = rho_ + program.actuators;
    frames_ = reinterpret_cast<PartFrame*>(drho_ + program.actuators);
  }

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

  /// N rows of `multiply`: as many sums at once, so that none waits for its own last addition.
  template <int N, bool add>
  static void multiply_rows(const double* A, int columns, const V* x, V* y) {
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

  /// y (+)= A x, A row-major and the same for all lanes; it has columns.
  template <bool add>
  static void multiply(const double* A, int rows, int columns, const V* x, V* y) {
    int r = 0;
    for (; rows - r >= 8; r += 8) multiply_rows<8, add>(A + r * columns, columns, x, y + r);
    switch (rows - r) {
      case 7: return multiply_rows<7, add>(A + r * columns, columns, x, y + r);
      case 6: return multiply_rows<6, add>(A + r * columns, columns, x, y + r);
      case 5: return multiply_rows<5, add>(A + r * columns, columns, x, y + r);
      case 4: return multiply_rows<4, add>(A + r * columns, columns, x, y + r);
      case 3: return multiply_rows<3, add>(A + r * columns, columns, x, y + r);
      case 2: return multiply_rows<2, add>(A + r * columns, columns, x, y + r);
      case 1: return multiply_rows<1, add>(A + r * columns, columns, x, y + r);
    }
  }

  /// sin t / t, (1 - cos t) / t^2, (t - sin t) / t^3 for t^2 = t2 up to 0.25^2.
  static void exp_coefficients(V t2, V& a, V& b, V& c) {
    a = 1 - t2 * (1.0 / 6) * (1 - t2 * (1.0 / 20) * (1 - t2 * (1.0 / 42) * (1 - t2 * (1.0 / 72) * (1 - t2 * (1.0 / 110)))));
    b = 0.5 - t2 * (1.0 / 24) * (1 - t2 * (1.0 / 30) * (1 - t2 * (1.0 / 56) * (1 - t2 * (1.0 / 90) * (1 - t2 * (1.0 / 132)))));
    c = 1.0 / 6 - t2 * (1.0 / 120) * (1 - t2 * (1.0 / 42) * (1 - t2 * (1.0 / 72) * (1 - t2 * (1.0 / 110))));
  }

  /// The rotation about phi.
  void exponential(const V* phi, V* E, V& b, V& c) {
    const V t2 = dot(phi, phi);
    note_angle(t2);
    V a;
    exp_coefficients(t2, a, b, c);
    const V x = phi[0], y = phi[1], z = phi[2];
    E[0] = 1 - b * (y * y + z * z);
    E[4] = 1 - b * (x * x + z * z);
    E[8] = 1 - b * (x * x + y * y);
    E[1] = b * x * y - a * z;
    E[3] = b * x * y + a * z;
    E[2] = b * x * z + a * y;
    E[6] = b * x * z - a * y;
    E[5] = b * y * z - a * x;
    E[7] = b * y * z + a * x;
  }

  void note_angle(V squared) { largest_angle2_ = larger(largest_angle2_, squared); }

  void apply_fixed(const FixedPose& fixed, Frame& X) {
    if (fixed.shifts)
      for (int i = 0; i < 3; ++i)
        X.p[i] += X.R[3 * i] * fixed.p[0] + X.R[3 * i + 1] * fixed.p[1] + X.R[3 * i + 2] * fixed.p[2];
    if (!fixed.turns) return;
    for (int i = 0; i < 3; ++i) {
      const V a = X.R[3 * i], b = X.R[3 * i + 1], c = X.R[3 * i + 2];
      for (int j = 0; j < 3; ++j) X.R[3 * i + j] = a * fixed.R[j] + b * fixed.R[3 + j] + c * fixed.R[6 + j];
    }
  }

  void apply_slide(const Part& part, Frame& X, PartFrame& at) {
    const V way = state_[part.value] * part.sign;
    for (int i = 0; i < 3; ++i) {
      at.R[i] = X.R[3 * i + part.axis] * part.sign;
      X.p[i] += X.R[3 * i + part.axis] * way;
    }
  }

  void apply_turn(const Part& part, Frame& X, PartFrame& at) {
    const V d = state_[part.value] - region_.start[part.value], d2 = d * d;
    note_angle(d2);
    V a, b, unused;
    exp_coefficients(d2, a, b, unused);
    const V sin_d = a * d, cos_d = 1 - b * d2;
    const double c0 = region_.cosine[part.value], s0 = region_.sine[part.value];
    const V c = c0 * cos_d - s0 * sin_d, s = (s0 * cos_d + c0 * sin_d) * part.sign;
    const int j = (part.axis + 1) % 3, k = (part.axis + 2) % 3;
    for (int i = 0; i < 3; ++i) {
      at.R[i] = X.R[3 * i + part.axis] * part.sign;
      at.o[i] = X.p[i];
      const V u = X.R[3 * i + j], v = X.R[3 * i + k];
      X.R[3 * i + j] = c * u + s * v;
      X.R[3 * i + k] = c * v - s * u;
    }
  }

  /// The part's frame before, and the point behind its translation; then its rotation.
  void apply_pose(const V* p, const V* R, Frame& X, PartFrame& at) {
    for (int i = 0; i < 9; ++i) at.R[i] = X.R[i];
    V way[3];
    rotate(X.R, p, way);
    for (int i = 0; i < 3; ++i) at.o[i] = X.p[i] += way[i];
    multiply(at.R, R, X.R);
  }

  void place(const Series& series, Frame& X) {
    for (int i = 0; i < 9; ++i) X.R[i] = broadcast(i % 4 == 0 ? 1 : 0);
    for (int i = 0; i < 3; ++i) X.p[i] = V{};
    for (int k = 0; k < series.part_count; ++k) {
      const Part& part = series.parts[k];
      switch (part.operation) {
        case Operation::fixed: apply_fixed(program_.fixed[question_.errors][part.fixed], X); break;
        case Operation::slide: apply_slide(part, X, frames_[k]); break;
        case Operation::turn: apply_turn(part, X, frames_[k]); break;
        case Operation::spring: {
          V E[9], b, c;
          exponential(state_ + part.value + 3, E, b, c);
          apply_pose(state_ + part.value, E, X, frames_[k]);
          break;
        }
        case Operation::group: apply_pose(state_ + part.value + 9, state_ + part.value, X, frames_[k]); break;
      }
    }
  }

  /// (p_to - p_from, Log(R_to R_from')), exact where it is small.
  void difference(const V* to, const Frame& from, V* d) {
    V D[9];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        D[3 * i + j] = to[3 * i] * from.R[3 * j] + to[3 * i + 1] * from.R[3 * j + 1] + to[3 * i + 2] * from.R[3 * j + 2];
    for (int i = 0; i < 3; ++i) d[i] = to[9 + i] - from.p[i];
    d[3] = 0.5 * (D[7] - D[5]);
    d[4] = 0.5 * (D[2] - D[6]);
    d[5] = 0.5 * (D[3] - D[1]);
    const V s2 = dot(d + 3, d + 3);
    note_angle(s2);
    note_angle(select(D[0] + D[4] + D[8] > 1, V{}, broadcast(1)));
    const V scale = 1 + s2 * (1.0 / 6) * (1 + s2 * (9.0 / 20) * (1 + s2 * (25.0 / 42)));
    for (int i = 3; i < 6; ++i) d[i] *= scale;
  }

  V joint_force(const Part& part) const {
    return (part.passive ? acting_springs_ * part.k : part.k) * (state_[part.value] - part.rest);
  }

  void spring_gradient(const Part& part, const V* f, const V* M_o, const PartFrame& at, V* gradient) {
    const V* theta = state_ + part.value;
    V stretch[6];
    for (int i = 0; i < 6; ++i) stretch[i] = theta[i] - acting_preload_ * part.K[36 + i];
    multiply<false>(part.K, 6, 6, stretch, gradient);
    V force[3], moment[3], turned[3], twice[3];
    into(at.R, f, force);
    into(at.R, M_o, moment);
    V a, b, c;
    exp_coefficients(dot(theta + 3, theta + 3), a, b, c);
    cross(theta + 3, moment, turned);  // J_l' M = M - b phi x M + c phi x (phi x M)
    cross(theta + 3, turned, twice);
    for (int i = 0; i < 3; ++i) gradient[i] -= force[i];
    for (int i = 0; i < 3; ++i) gradient[3 + i] -= moment[i] - b * turned[i] + c * twice[i];
  }

  void group_gradient(const Part& part, const V* f, const V* M_o, const PartFrame& at, V* gradient) {
    V force[3], moment[3];
    into(at.R, f, force);
    into(at.R, M_o, moment);
    for (int i = 0; i < 3; ++i) gradient[i] = -force[i];
    for (int i = 0; i < 3; ++i) gradient[3 + i] = -moment[i];
    for (int b = 0; b < part.branches; ++b)
      for (int i = 0; i < 6; ++i) gradient[i] += state_[program_.series[part.first_branch + b].wrench + i];
  }

  /// Gap and gradient of a series: its right-hand side.
  void evaluate(const Series& series) {
    Frame X;
    place(series, X);
    V* rhs = rhs_ + series.step;
    difference(state_ + series.end, X, rhs);
    const V *f = state_ + series.wrench, *m = f + 3;
    for (int k = 0; k < series.part_count; ++k) {
      const Part& part = series.parts[k];
      if (part.operation == Operation::fixed || part.row < 0) continue;
      const PartFrame& at = frames_[k];
      V* gradient = rhs + part.row;
      if (part.operation == Operation::slide) {
        gradient[0] = joint_force(part) - dot(at.R, f);
        continue;
      }
      V r[3], M_o[3];
      for (int i = 0; i < 3; ++i) r[i] = X.p[i] - at.o[i];
      cross(r, f, M_o);
      for (int i = 0; i < 3; ++i) M_o[i] += m[i];
      if (part.operation == Operation::turn)
        gradient[0] = joint_force(part) - dot(at.R, M_o);
      else if (part.operation == Operation::spring)
        spring_gradient(part, f, M_o, at, gradient);
      else
        group_gradient(part, f, M_o, at, gradient);
    }
    note_residual(series, rhs, f);
  }

  void note_wrench(const V* F) { wrench2_ = larger(wrench2_, wrench_size2(F)); }
  V wrench_size2(const V* F) {
    const double l = program_.length;
    return larger(dot(F, F), dot(F + 3, F + 3) * (1 / (l * l)));
  }

  void note_residual(const Series& series, const V* rhs, const V* F) {
    const double l = program_.length;
    closure2_ = larger(closure2_, larger(dot(rhs, rhs), dot(rhs + 3, rhs + 3) * (l * l)));
    for (int i = 6; i < series.rows; ++i) force_ = larger(force_, magnitude(rhs[i]) * (series.angular[i - 6] ? 1 / l : 1));
    note_wrench(F);
  }

  /// Eliminates the inside of every series, branches first: steps for a held end.
  void eliminate() {
    for (int s = 0; s < program_.series_count; ++s) {
      const Series& series = program_.series[s];
      V* rhs = rhs_ + series.step;
      for (int k = 0; k < series.part_count; ++k) {
        const Part& part = series.parts[k];
        if (part.operation != Operation::group) continue;
        for (int b = 0; b < part.branches; ++b)
          for (int i = 0; i < 6; ++i) rhs[part.row + i] += step_[program_.series[part.first_branch + b].step + i];
      }
      multiply<false>(region_.tangents + series.inside, series.rows, series.rows, rhs, step_ + series.step);
    }
  }

  /// Balance of the platform and error of the tip.
  void evaluate_platform() {
    const V* X = state_ + program_.platform;
    V arm[3], r[3], moment[3];
    for (int i = 0; i < 3; ++i) arm[i] = broadcast(program_.arm[i]);
    rotate(X, arm, r);
    cross(r, F_, moment);
    for (int i = 0; i < 3; ++i) balance_[i] = F_[i];
    for (int i = 0; i < 3; ++i) balance_[3 + i] = F_[3 + i] + moment[i];
    for (int s = 0; s < program_.series_count; ++s)
      if (program_.series[s].is_chain)
        for (int i = 0; i < 6; ++i) balance_[i] -= state_[program_.series[s].wrench + i];
    balance2_ = wrench_size2(balance_);
    note_wrench(F_);
    if (!question_.target && !question_.kinematics) return;
    find_tip();
    for (int i = 0; i < 3; ++i) balance_[6 + i] = wanted_[i] - tip_[i];
    if (question_.kinematics) compare_controlled();
    for (int i = 6; i < 6 + tip_equations(); ++i) closure2_ = larger(closure2_, balance_[i] * balance_[i]);
  }

  int tip_equations() const { return question_.kinematics ? program_.actuators : 3; }

  /// Errors of all components that the machine controls.
  void compare_controlled() {
    Frame tip;
    V wanted[12], all[6], R_PT[9];
    for (int i = 0; i < 9; ++i) R_PT[i] = broadcast(program_.R_PT[i]);
    multiply(state_ + program_.platform, R_PT, tip.R);
    for (int i = 0; i < 9; ++i) wanted[i] = broadcast(program_.R_MT_home[i]);
    for (int i = 0; i < 3; ++i) wanted[9 + i] = wanted_[i];
    for (int i = 0; i < 3; ++i) tip.p[i] = tip_[i];
    difference(wanted, tip, all);
    for (int i = 0; i < program_.actuators; ++i) balance_[6 + i] = all[program_.controlled[i]];
  }

  void find_tip() {
    const V* X = state_ + program_.platform;
    for (int i = 0; i < 3; ++i)
      tip_[i] = X[9 + i] + X[3 * i] * program_.p_PT[0] + X[3 * i + 1] * program_.p_PT[1] + X[3 * i + 2] * program_.p_PT[2];
  }

  void solve_platform() {
    for (int s = 0; s < program_.series_count; ++s)
      if (program_.series[s].is_chain)
        for (int i = 0; i < 6; ++i) balance_[i] -= step_[program_.series[s].step + i];
    V x[6 + most_actuators];
    if (question_.kinematics)
      multiply<false>(region_.kinematic, 6 + program_.actuators, 6 + program_.actuators, balance_, x);
    else if (question_.target)
      multiply<false>(region_.tangents + program_.target, 9, 9, balance_, x);
    else
      multiply<false>(region_.tangents + program_.forward, 6, 6, balance_, x);
    if (question_.target && region_.bend != nullptr) straighten(x);
    for (int i = 0; i < 6; ++i) twist_[i] = x[i];
    if (question_.kinematics)
      for (int a = 0; a < program_.actuators; ++a) drho_[a] = x[6 + a];
    if (!question_.target) return;
    for (int i = 0; i < 3; ++i) next_p_[i] = p_[i] + x[6 + i];
    V rho[most_actuators];
    find_actuators(next_p_, rho);
    for (int a = 0; a < program_.actuators; ++a) drho_[a] = rho[a] - rho_[a];
  }

  /// Actuators change by the commanded position otherwise here than where the tangents were taken.
  void straighten(V* x) {
    V away[3], more[most_actuators], change[9];
    for (int i = 0; i < 3; ++i) away[i] = p_[i] - region_.place[i];
    for (int a = 0; a < program_.actuators; ++a) {
      more[a] = V{};
      for (int i = 0; i < 3; ++i) {
        const double* bend = region_.bend + 9 * a + 3 * i;
        more[a] += away[i] * (bend[0] * x[6] + bend[1] * x[7] + bend[2] * x[8]);
      }
    }
    multiply<false>(region_.straighten, 9, program_.actuators, more, change);
    for (int i = 0; i < 9; ++i) x[i] += change[i];
  }

  /// The rest of all steps, from the platform inwards; their largest entry, that of the platform's twist from above.
  void distribute(bool moves) {
    constexpr double axes = 1.7320508075688773;  // a vector is at most so much longer than its largest component
    const double l = program_.length;
    largest_step_ = V{};
    for (int i = 0; i < 6; ++i) largest_step_ = larger(largest_step_, magnitude(twist_[i]) * (i < 3 ? axes : axes * l));
    for (int s = program_.series_count - 1; s >= 0; --s) {
      const Series& series = program_.series[s];
      V* step = step_ + series.step;
      const V* end = series.is_chain ? twist_ : end_step_[s];
      multiply<true>(region_.tangents + series.by_end, series.rows, 6, end, step);
      if (moves && series.actuators > 0) {
        V own[most_actuators];
        for (int a = 0; a < series.actuators; ++a) own[a] = drho_[program_.actuator_numbers[series.first_actuator + a]];
        multiply<true>(region_.tangents + series.by_actuators, series.rows, series.actuators, own, step);
      }
      for (int i = 6; i < series.rows; ++i)
        largest_step_ = larger(largest_step_, magnitude(step[i]) * (series.angular[i - 6] ? l : 1));
      for (int k = 0; k < series.part_count; ++k)
        if (series.parts[k].operation == Operation::group)
          for (int b = 0; b < series.parts[k].branches; ++b)
            end_step_[series.parts[k].first_branch + b] = step + series.parts[k].row;
    }
  }

  bool moves_actuators() const { return question_.target || question_.kinematics; }

  V kept(V step) const { return (V)((M)step & active_); }

  void move_pose(V* X, const V* step) {
    V phi[3], E[9], b, c, R[9];
    for (int i = 0; i < 3; ++i) phi[i] = kept(step[3 + i]);
    exponential(phi, E, b, c);
    for (int i = 0; i < 9; ++i) R[i] = X[i];
    multiply(E, R, X);
    for (int i = 0; i < 3; ++i) X[9 + i] += kept(step[i]);
  }

  void take_step() {
    move_bodies();
    if (!moves_actuators()) return;
    if (question_.target)
      for (int i = 0; i < 3; ++i) p_[i] += kept(next_p_[i] - p_[i]);
    for (int a = 0; a < program_.actuators; ++a) rho_[a] += kept(drho_[a]);
    set_actuators();
  }

  /// Everything but actuators.
  void move_bodies() {
    for (int s = 0; s < program_.series_count; ++s) {
      const Series& series = program_.series[s];
      const V* step = step_ + series.step;
      for (int i = 0; i < 6; ++i) state_[series.wrench + i] += kept(step[i]);
      for (int k = 0; k < series.part_count; ++k) {
        const Part& part = series.parts[k];
        if (part.operation == Operation::fixed) continue;
        if (part.operation == Operation::group) {
          move_pose(state_ + part.value, step + part.row);
          continue;
        }
        if (part.row < 0) continue;
        const int count = part.operation == Operation::spring ? 6 : 1;
        for (int i = 0; i < count; ++i) state_[part.value + i] += kept(step[part.row + i]);
      }
    }
    move_pose(state_ + program_.platform, twist_);
  }

  /// From the state with which the call begins.
  void take_actuators() {
    for (int s = 0; s < program_.series_count; ++s)
      for (int k = 0; k < program_.series[s].part_count; ++k) {
        const Part& part = program_.series[s].parts[k];
        if (part.operation != Operation::fixed && part.actuator >= 0) rho_[part.actuator] = state_[part.value];
      }
  }

  void set_actuators() {
    for (int s = 0; s < program_.series_count; ++s)
      for (int k = 0; k < program_.series[s].part_count; ++k) {
        const Part& part = program_.series[s].parts[k];
        if (part.operation != Operation::fixed && part.actuator >= 0) state_[part.value] = rho_[part.actuator];
      }
  }

  /// Actuators for a commanded position.
  void find_actuators(const V* p, V* rho) {
    V x[3];
    for (int i = 0; i < 3; ++i) x[i] = (p[i] - region_.centre[i]) * (1 / region_.half);
    const int n = program_.actuators;
    for (int a = 0; a < n;) {
      if (n - a >= 3) {
        evaluate_polynomials<3>(x, region_.polynomials + a, n, rho + a);
        a += 3;
      } else {
        evaluate_polynomials<1>(x, region_.polynomials + a, n, rho + a);
        ++a;
      }
    }
  }

  /// N polynomials at once by Horner's rule; coefficients stand from the highest powers down, `stride` apart.
  template <int N>
  void evaluate_polynomials(const V* x, const double* c, int stride, V* out) {
    V sum_x[N]{}, sum_y[N], sum_z[N];
    for (int i = 0; i <= region_.degree; ++i) {
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

  void begin(const Batch& batch) {
    for (int i = 0; i < 3; ++i)
      for (int lane = 0; lane < W; ++lane) p_[i][lane] = batch.p[i][first_ + lane];
    for (int i = 0; i < 6; ++i)
      for (int lane = 0; lane < W; ++lane) F_[i][lane] = batch.F[i][first_ + lane];
    for (int i = 0; i < 3; ++i) wanted_[i] = p_[i];
    active_ = p_[0] == p_[0];
    if (question_.go_on)
      find_standing();
    else
      stand_at_start();
    if (question_.kinematics)
      take_actuators();
    else
      find_actuators(p_, rho_);
    set_actuators();
    converged_ = active_ & ~active_;
    iterations_ = V{};
  }

  /// Where the unloaded machine stands, by polynomials of the place, and what the load moves to first order.
  void stand_at_start() {
    for (int i = 0; i < program_.states; ++i) state_[i] = broadcast(region_.start[i]);
    if (region_.displacement == nullptr) return;
    V x[3], powers[most_monomials];
    for (int i = 0; i < 3; ++i) x[i] = (p_[i] - region_.displacement_centre[i]) * (1 / region_.displacement_half);
    const int count = find_monomials(x, powers), rows = program_.rows;
    const double* response = region_.tangents + program_.response;
    multiply<false>(region_.displacement, rows, count, powers, step_);
    multiply<false>(region_.displacement + rows * count, 6, count, powers, twist_);
    multiply<true>(response, rows, 6, F_, step_);
    multiply<true>(response + rows * 6, 6, 6, F_, twist_);
    move_bodies();
  }

  /// All powers together up to the degree, in the order of `evaluate_polynomials`.
  int find_monomials(const V* x, V* powers) const {
    const int degree = region_.displacement_degree;
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

  /// The first step of lanes that stand at an equilibrium, for another command or load: no series misses anything yet, only
  /// the platform need be looked at.
  void take_first_step() {
    const M all = active_;
    active_ &= standing_;
    if (any(active_)) {
      for (int i = 0; i < program_.rows; ++i) step_[i] = V{};
      evaluate_platform();
      if (!question_.target) pull_platform();
      solve_platform();
      distribute(true);
      iterations_ += (V)((M)broadcast(1) & active_);
      take_step();
    }
    active_ = all;
  }

  /// What the way of the actuators to the command does to the balance of a platform that stays.
  void pull_platform() {
    find_actuators(from_, drho_);
    for (int a = 0; a < program_.actuators; ++a) drho_[a] = rho_[a] - drho_[a];
    for (int s = 0; s < program_.series_count; ++s) {
      const Series& series = program_.series[s];
      if (!series.is_chain || series.actuators == 0) continue;
      V own[most_actuators], wrench[6];
      for (int a = 0; a < series.actuators; ++a) own[a] = drho_[program_.actuator_numbers[series.first_actuator + a]];
      multiply<false>(region_.tangents + series.by_actuators, 6, series.actuators, own, wrench);
      for (int i = 0; i < 6; ++i) balance_[i] -= wrench[i];
    }
  }

  /// Lanes that stand at an equilibrium; a target goes on from its command.
  void find_standing() {
    const V* standing = state_ + program_.standing;
    standing_ = standing[3] > V{};
    for (int i = 0; i < 3; ++i) from_[i] = standing[i];
    if (!question_.target) return;
    for (int i = 0; i < 3; ++i) p_[i] = select(standing_, from_[i], p_[i]);
  }

  V force_limit() {
    const V* X = state_ + program_.platform;
    return 1e-9 * larger(broadcast(1), root(wrench2_)) +
           program_.floor_per_metre * (root(dot(X + 9, X + 9)) + program_.length);
  }

  /// Lanes in which what the next step would still move is within the limit: it is not taken any more.
  M are_done() {
    const M near = (closure2_ <= closure_limit * closure_limit) &
                   (largest_step_ <= (question_.kinematics ? kinematic_step_limit : step_limit)) &
                   (largest_angle2_ <= largest_angle * largest_angle);
    if (!any(near & active_)) return near & active_;
    const V limit = force_limit();
    return near & (force_ <= limit) & (balance2_ <= limit * limit);
  }

  void run(Batch& batch) {
    begin(batch);
    take_first_step();
    for (int iteration = 0; iteration < (question_.kinematics ? 3 : 1) * most_iterations; ++iteration) {
      closure2_ = force_ = wrench2_ = largest_angle2_ = V{};
      for (int s = 0; s < program_.series_count; ++s) evaluate(program_.series[s]);
      evaluate_platform();
      eliminate();
      solve_platform();
      distribute(moves_actuators());
      const M done = are_done();
      converged_ |= done & active_;
      active_ &= ~done;
      if (!any(active_)) break;
      iterations_ += (V)((M)broadcast(1) & active_);
      take_step();
    }
    finish(batch);
  }

  /// Where lanes stand now. A lane that failed leaves no state to go on from.
  void leave_state() {
    for (int i = 0; i < program_.states; ++i) state_[i] = select(converged_, state_[i], broadcast(region_.start[i]));
    V* standing = state_ + program_.standing;
    for (int i = 0; i < 3; ++i) standing[i] = p_[i];
    standing[3] = select(converged_, broadcast(question_.kinematics ? 0 : 1), V{});
  }

  void finish(Batch& batch) {
    find_tip();
    const V* X = state_ + program_.platform;
    V R_PT[9], R[9];
    for (int i = 0; i < 9; ++i) R_PT[i] = broadcast(program_.R_PT[i]);
    multiply(X, R_PT, R);
    for (int lane = 0; lane < W; ++lane) {
      const int at = first_ + lane;
      for (int i = 0; i < 9; ++i) batch.tip[i][at] = R[i][lane];
      for (int i = 0; i < 3; ++i) batch.tip[9 + i][at] = tip_[i][lane];
      for (int i = 0; i < 3; ++i) batch.p[i][at] = p_[i][lane];
      for (int a = 0; a < program_.actuators; ++a) batch.rho[a * width + at] = rho_[a][lane];
      batch.iterations[at] = iterations_[lane];
      batch.converged[at] = converged_[lane] != 0;
    }
    leave_state();
  }


  const Program& program_;
  const Region& region_;
  const Question question_;
  const double acting_springs_ = question_.kinematics ? 0 : 1, acting_preload_ = acting_springs_;
  const int first_;
  V *state_, *rhs_, *step_, *rho_, *drho_;
  PartFrame* frames_;
  const V* end_step_[most_series];
  V F_[6], p_[3], wanted_[3], from_[3], next_p_[3], tip_[3], balance_[6 + most_actuators], twist_[6];
  V closure2_{}, force_{}, balance2_{}, wrench2_{}, largest_angle2_{}, largest_step_{}, iterations_{};
  M active_{}, converged_{}, standing_{};
};

}  // namespace counterflex::lanes
