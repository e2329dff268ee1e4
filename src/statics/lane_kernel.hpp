#pragma once
/// The kernel behind lane_program.hpp for vectors of W doubles. Lanes never meet: each is solved as if it were alone, with
/// the same operations in the same order for every W, so that results depend on the instruction set by fused multiply-adds alone.
#include "lane_series.hpp"

namespace counterflex::lanes {

template <int W>
class LaneKernel : LaneSeries<W> {
  template <int>
  friend class LaneCertificate;
  using Base = LaneSeries<W>;
  using V = typename Base::V;
  using M = typename Base::M;
  using Frame = typename Base::Frame;
  using PartFrame = typename Base::PartFrame;
  using SeriesWeights = typename Base::SeriesWeights;
  using Base::broadcast;
  using Base::select;
  using Base::larger;
  using Base::magnitude;
  using Base::dot;
  using Base::cross;
  using Base::rotate;
  using Base::multiply;
  using Base::product;
  using Base::add_product;
  using Base::any;
  using Base::root;
  using Base::place;
  using Base::evaluate;
  using Base::turn_branches;
  using Base::difference;
  using Base::exponential;
  using Base::note_wrench;
  using Base::wrench_size2;
  using Base::forget_residuals;
  using Base::program_;
  using Base::region_;
  using Base::question_;
  using Base::state_;
  using Base::rhs_;
  using Base::frames_;
  using Base::weights_;
  using Base::closure2_;
  using Base::force_;
  using Base::wrench2_;
  using Base::largest_angle2_;

  static constexpr double closure_limit = 1e-12, step_limit = 1e-11, largest_angle = 0.25;
  static constexpr double kinematic_step_limit = 1e-13;
  static constexpr int most_iterations = 16;

 public:
  static void solve(const Program& program, const Region& region, const Question& question, Batch& batch, double* memory) {
    for (int first = 0; first < width; first += W) {
      LaneKernel kernel(program, region, question, memory, first);
      kernel.run(batch);
    }
  }

 private:
  LaneKernel(const Program& program, const Region& region, const Question& question, double* memory, int first)
      : Base(program, region, question), first_(first) {
    // State of all lanes first (it survives), then what one call uses.
    state_ = reinterpret_cast<V*>(memory) + static_cast<long>(first / W) * program.states;
    V* rest = reinterpret_cast<V*>(memory + static_cast<long>(width) * program.states);
    rhs_ = rest;
    step_ = rhs_ + program.rows;
    rho_ = step_ + program.rows;
    drho_ = rho_ + program.actuators;
    frames_ = reinterpret_cast<PartFrame*>(drho_ + program.actuators);
    weights_ = reinterpret_cast<SeriesWeights*>(frames_ + program.most_parts);
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
      product(region_.tangents + series.inside, series.rows, series.rows, rhs, step_ + series.step);
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
      product(region_.kinematic, 6 + program_.actuators, 6 + program_.actuators, balance_, x);
    else if (question_.target)
      product(region_.tangents + program_.target, 9, 9, balance_, x);
    else
      product(region_.tangents + program_.forward, 6, 6, balance_, x);
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
    product(region_.straighten, 9, program_.actuators, more, change);
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
      add_product(region_.tangents + series.by_end, series.rows, 6, end, step);
      if (moves && series.actuators > 0) {
        V own[most_actuators];
        for (int a = 0; a < series.actuators; ++a) own[a] = drho_[program_.actuator_numbers[series.first_actuator + a]];
        add_product(region_.tangents + series.by_actuators, series.rows, series.actuators, own, step);
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
    turned2_ = larger(turned2_, dot(phi, phi));
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
        if (part.row < 0) continue;
        if (part.operation == Operation::group) {
          move_pose(state_ + part.value, step + part.row);
          continue;
        }
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
    Base::evaluate_polynomials(program_.actuators, region_.degree, region_.polynomials, x, rho);
  }

  void begin(const Batch& batch) {
    for (int i = 0; i < 3; ++i)
      for (int lane = 0; lane < W; ++lane) p_[i][lane] = batch.p[i][first_ + lane];
    for (int i = 0; i < 6; ++i)
      for (int lane = 0; lane < W; ++lane) F_[i][lane] = batch.F[i][first_ + lane];
    for (int i = 0; i < 3; ++i) wanted_[i] = p_[i];
    active_ = p_[0] == p_[0];
    if (question_.go_on) find_standing();
    stand_at_start();
    if (question_.kinematics)
      take_actuators();
    else
      find_actuators(p_, rho_);
    set_actuators();
    converged_ = active_ & ~active_;
    iterations_ = V{};
  }

  /// Lanes that stand nowhere: where the unloaded machine is, by polynomials of the place, and what the load moves to first
  /// order.
  void stand_at_start() {
    const M all = active_;
    active_ &= ~standing_;
    if (any(active_)) go_to_start();
    active_ = all;
  }

  void go_to_start() {
    for (int i = 0; i < program_.states; ++i) state_[i] = select(standing_, state_[i], broadcast(region_.start[i]));
    if (region_.displacement == nullptr) return;
    V x[3], powers[most_monomials];
    for (int i = 0; i < 3; ++i) x[i] = (p_[i] - region_.displacement_centre[i]) * (1 / region_.displacement_half);
    const int count = Base::find_monomials(region_.displacement_degree, x, powers), rows = program_.rows;
    const double* response = region_.tangents + program_.response;
    product(region_.displacement, rows, count, powers, step_);
    product(region_.displacement + rows * count, 6, count, powers, twist_);
    add_product(response, rows, 6, F_, step_);
    add_product(response + rows * 6, 6, 6, F_, twist_);
    move_bodies();
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
      product(region_.tangents + series.by_actuators, 6, series.actuators, own, wrench);
      for (int i = 0; i < 6; ++i) balance_[i] -= wrench[i];
    }
  }

  /// Lanes that stand at an equilibrium of a command for which the polynomials hold; a target goes on from there.
  void find_standing() {
    const V* standing = state_ + program_.standing;
    standing_ = standing[3] > V{};
    for (int i = 0; i < 3; ++i) {
      from_[i] = standing[i];
      standing_ &= magnitude(from_[i] - region_.centre[i]) <= region_.half;
    }
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
                   (largest_angle2_ <= largest_angle * largest_angle) & (turned2_ <= largest_angle * largest_angle);
    if (!any(near & active_)) return near & active_;
    const V limit = force_limit();
    return near & (force_ <= limit) & (balance2_ <= limit * limit);
  }

  void run(Batch& batch) {
    begin(batch);
    take_first_step();
    for (int iteration = 0; iteration < (question_.kinematics ? 3 : 1) * most_iterations; ++iteration) {
      forget_residuals();
      turn_branches();
      for (int s = 0; s < program_.series_count; ++s) evaluate(s);
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

  const int first_;
  V *step_, *rho_, *drho_;
  const V* end_step_[most_series];
  V F_[6], p_[3], wanted_[3], from_[3], next_p_[3], tip_[3], balance_[6 + most_actuators], twist_[6];
  V balance2_{}, largest_step_{}, iterations_{};
  V turned2_{};  ///< the largest turn of a pose by a step of this call
  M active_{}, converged_{}, standing_{};
};

}  // namespace counterflex::lanes
