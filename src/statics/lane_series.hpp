#pragma once
/// A series in lanes: where its parts stand, and its residual.
#include "lane_vectors.hpp"

namespace counterflex::lanes {

template <int W>
class LaneSeries : protected LaneVectors<W> {
  using Base = LaneVectors<W>;

 protected:
  using V = typename Base::V;
  using M = typename Base::M;
  using Base::broadcast;
  using Base::select;
  using Base::larger;
  using Base::magnitude;
  using Base::dot;
  using Base::cross;
  using Base::into;
  using Base::rotate;
  using Base::multiply;
  using Base::product;
  using Base::exp_coefficients;

  struct Frame {
    V R[9], p[3];
  };

  /// Where a part acts: its axes before, and the point about which it turns.
  struct PartFrame {
    V R[9], o[3];
  };

  /// What the masses of a series, those of its branches included, mean to the series around it.
  struct SeriesWeights {
    V first_moment[3];  ///< sum of mass times place, from the series' start, in its axes
    V R_start[9];       ///< of its start frame in that of its chain
  };

  LaneSeries(const Program& program, const Region& region, const Question& question)
      : program_(program), region_(region), question_(question) {}

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
    const V way = (state_[part.value] + acting_gravity_ * part.offset) * part.sign;
    for (int i = 0; i < 3; ++i) {
      at.R[i] = X.R[3 * i + part.axis] * part.sign;
      X.p[i] += X.R[3 * i + part.axis] * way;
    }
  }

  void apply_turn(const Part& part, Frame& X, PartFrame& at) {
    const V d = state_[part.value] + acting_gravity_ * part.offset - region_.start[part.value], d2 = d * d;
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

  void place_mass(const Part& part, const Frame& X, PartFrame& at) {
    V at_axes[3], way[3];
    for (int i = 0; i < 3; ++i) at_axes[i] = broadcast(part.at[i]);
    rotate(X.R, at_axes, way);
    for (int i = 0; i < 3; ++i) at.o[i] = X.p[i] + way[i];
  }

  void place(const Series& series, Frame& X) {
    for (int i = 0; i < 9; ++i) X.R[i] = broadcast(i % 4 == 0 ? 1 : 0);
    for (int i = 0; i < 3; ++i) X.p[i] = V{};
    for (int k = 0; k < series.part_count; ++k) {
      const Part& part = series.parts[k];
      switch (part.operation) {
        case Operation::fixed: apply_fixed(program_.fixed[question_.acting.errors][part.fixed], X); break;
        case Operation::slide: apply_slide(part, X, frames_[k]); break;
        case Operation::turn: apply_turn(part, X, frames_[k]); break;
        case Operation::spring: {
          V E[9], b, c;
          exponential(state_ + part.value + 3, E, b, c);
          apply_pose(state_ + part.value, E, X, frames_[k]);
          break;
        }
        case Operation::group: apply_pose(state_ + part.value + 9, state_ + part.value, X, frames_[k]); break;
        case Operation::mass: place_mass(part, X, frames_[k]); break;
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
    product(part.K, 6, 6, stretch, gradient);
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

  /// What pulls at a part, from the end of its series and from the masses between: f, and m about the end.
  struct Pull {
    V f[3], m[3];
  };

  /// A mass of which `mass_r` is the mass times its place from the end of the series.
  void add_weight(double mass, const V* mass_r, Pull& pull) {
    V moment[3];
    cross(mass_r, gravity_, moment);
    for (int i = 0; i < 3; ++i) pull.f[i] += mass * gravity_[i];
    for (int i = 0; i < 3; ++i) pull.m[i] += moment[i];
  }

  /// `first_moment`: the mass times its place from the start of the series, of which `X` is the end.
  void carry(double mass, const V* first_moment, const Frame& X, V* carried, Pull& pull) {
    V mass_r[3];
    for (int i = 0; i < 3; ++i) carried[i] += first_moment[i];
    for (int i = 0; i < 3; ++i) mass_r[i] = first_moment[i] - mass * X.p[i];
    add_weight(mass, mass_r, pull);
  }

  void carry_mass(const Part& part, const PartFrame& at, const Frame& X, V* carried, Pull& pull) {
    V first_moment[3];
    for (int i = 0; i < 3; ++i) first_moment[i] = part.mass * at.o[i];
    carry(part.mass, first_moment, X, carried, pull);
  }

  /// A group's end does not carry the masses of its branches; what carries its start does.
  void carry_branches(const Part& part, const PartFrame& at, const Frame& X, V* carried, Pull& pull) {
    V way[3], first_moment[3];
    rotate(at.R, state_ + part.value + 9, way);
    for (int b = part.first_branch; b < part.first_branch + part.branches; ++b) {
      const double mass = program_.series[b].mass;
      if (mass == 0) continue;
      rotate(at.R, weights_[b].first_moment, first_moment);
      for (int i = 0; i < 3; ++i) first_moment[i] += mass * (at.o[i] - way[i]);
      carry(mass, first_moment, X, carried, pull);
    }
  }

  /// How the start frames of branches stand to those of their chains: where down is, for a branch with masses.
  void turn_branches() {
    if (!program_.branches_weigh || acting_gravity_ == 0) return;
    for (int s = program_.series_count - 1; s >= 0; --s) {
      const Series& series = program_.series[s];
      if (series.is_chain)
        for (int i = 0; i < 9; ++i) weights_[s].R_start[i] = broadcast(i % 4 == 0 ? 1 : 0);
      if (series.mass == 0) continue;
      Frame X;
      place(series, X);
      for (int k = 0; k < series.part_count; ++k)
        if (const Part& part = series.parts[k]; part.operation == Operation::group)
          for (int b = 0; b < part.branches; ++b)
            multiply(weights_[s].R_start, frames_[k].R, weights_[part.first_branch + b].R_start);
    }
  }

  /// Gravity in the axes of a series' start frame.
  void find_gravity(int number) {
    V g[3];
    for (int i = 0; i < 3; ++i) gravity_[i] = g[i] = acting_gravity_ * broadcast(program_.gravity[i]);
    const Series& series = program_.series[number];
    if (!series.is_chain && acting_gravity_ != 0) into(weights_[number].R_start, g, gravity_);
  }

  /// Gap and gradient of a series: its right-hand side.
  void evaluate(int number) {
    const Series& series = program_.series[number];
    Frame X;
    place(series, X);
    V* rhs = rhs_ + series.step;
    difference(state_ + series.end, X, rhs);
    const V* F = state_ + series.wrench;
    Pull pull;
    for (int i = 0; i < 3; ++i) pull.f[i] = F[i];
    for (int i = 0; i < 3; ++i) pull.m[i] = F[3 + i];
    const bool weighs = series.mass > 0;
    V carried[3]{};
    if (weighs) find_gravity(number);
    for (int k = series.part_count - 1; k >= 0; --k) {
      const Part& part = series.parts[k];
      if (part.operation == Operation::mass) carry_mass(part, frames_[k], X, carried, pull);
      if (part.row >= 0) find_gradient(part, pull, X, frames_[k], rhs + part.row);
      if (weighs && part.operation == Operation::group) carry_branches(part, frames_[k], X, carried, pull);
    }
    if (weighs)
      for (int i = 0; i < 3; ++i) weights_[number].first_moment[i] = carried[i];
    note_residual(series, rhs, F);
  }

  void find_gradient(const Part& part, const Pull& pull, const Frame& X, const PartFrame& at, V* gradient) {
    if (part.operation == Operation::slide) {
      gradient[0] = joint_force(part) - dot(at.R, pull.f);
      return;
    }
    V r[3], M_o[3];
    for (int i = 0; i < 3; ++i) r[i] = X.p[i] - at.o[i];
    cross(r, pull.f, M_o);
    for (int i = 0; i < 3; ++i) M_o[i] += pull.m[i];
    if (part.operation == Operation::turn)
      gradient[0] = joint_force(part) - dot(at.R, M_o);
    else if (part.operation == Operation::spring)
      spring_gradient(part, pull.f, M_o, at, gradient);
    else
      group_gradient(part, pull.f, M_o, at, gradient);
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
    if (series.mass > 0) wrench2_ = larger(wrench2_, series.mass * series.mass * dot(gravity_, gravity_));
  }

  void forget_residuals() { closure2_ = force_ = wrench2_ = largest_angle2_ = V{}; }

  const Program& program_;
  const Region& region_;
  const Question question_;
  const double acting_springs_ = question_.kinematics ? 0 : 1, acting_preload_ = acting_springs_,
               acting_gravity_ = question_.acting.weights ? acting_springs_ : 0;
  V *state_ = nullptr, *rhs_ = nullptr;
  PartFrame* frames_ = nullptr;  ///< of the parts of the series that was placed last
  SeriesWeights* weights_ = nullptr;  ///< by series; of those with masses
  V gravity_[3]{};  ///< m/s2, in the axes of the start frame of the series that is evaluated
  V closure2_{}, force_{}, wrench2_{}, largest_angle2_{};  ///< the largest of all series
};

}  // namespace counterflex::lanes
