#pragma once
/// Waypoints that begin in cells, in the lanes of one instance. EQUATIONS.md, section 11, "Starts".
#include "statics/kernel/newton.hpp"

namespace counterflex::kernel {

/// The waypoint of a lane. The last one fills the lanes that are left.
COUNTERFLEX_INLINE int waypoint_of(const Batch& batch, int first, int lane) {
  return first + lane < batch.count() ? first + lane : batch.count() - 1;
}

/// Calls `visit(cell, lanes)` for every cell that one of the waypoints from `first` on has, and their lanes.
template <class T, class Visit>
COUNTERFLEX_INLINE void for_each_cell(const Batch& batch, int first,
                                      const std::vector<const StartCell*>& cells, const Visit& visit) {
  const auto of = [&](int l) { return at(cells, waypoint_of(batch, first, l)); };
  for (int l = 0; l < lane_count<T>; ++l) {
    bool is_new = true;
    for (int k = 0; k < l; ++k) is_new = is_new && of(k) != of(l);
    if (is_new) visit(*of(l), lanes_where<T>([&](int k) { return of(k) == of(l); }));
  }
}

/// The terms of polynomials at a point, without those of what acts in no lane.
template <class T>
struct TermValues {
  T value[most_terms];
  Acting acting;
};

template <class T>
COUNTERFLEX_INLINE void fill(const Polynomials& polynomials, const Point<T>& x, Acting acting,
                             TermValues<T>& values) {
  values.acting = acting;
  for (std::size_t k = 0; k < polynomials.count(acting); ++k)
    values.value[k] = x.value_of(polynomials.terms[k]);
}

template <class T>
COUNTERFLEX_INLINE Block<T> sum(const Polynomials& polynomials, int block_number,
                                const TermValues<T>& values) {
  const double* coefficients = polynomials.coefficients.data() +
                               block * polynomials.terms.size() * static_cast<std::size_t>(block_number);
  Block<T> sum{};
  for (std::size_t k = 0; k < polynomials.count(values.acting); ++k, coefficients += block) {
    COUNTERFLEX_UNROLL
    for (int i = 0; i < block; ++i) sum.value[i] += coefficients[i] * values.value[k];
  }
  return sum;
}

/// Puts the state that a cell has for the variables x into its lanes. `terms`: those of the cell's changes at
/// x.
template <class T>
void put_state_of_cell(const StartCell& cell, const Mask<T>& lanes, const Point<T>& x,
                       const TermValues<T>& terms, Work<T>& work) {
  const FlatMachine& machine = work.machine;
  const auto put = [&](T value, T& to) { to = select<T>(lanes, value, to); };
  int block_number = 0;
  for (int begin = 0; begin < machine.joints; begin += block, ++block_number) {
    const Block<T> dq = sum(cell.changes, block_number, terms);
    for (int i = 0; i < block && begin + i < machine.joints; ++i) {
      const int j = begin + i;
      JointState<T> found{all<T>(at(cell.state, j)), all<T>(at(cell.cosine, j)), all<T>(at(cell.sine, j))};
      move_joint(dq.value[i], at(machine.joint_turns, j) != 0, found);
      JointState<T>& joint = at(work.state.joints, j);
      put(found.q, joint.q), put(found.cosine, joint.cosine), put(found.sine, joint.sine);
    }
  }
  for (int i = 0; i <= machine.nodes; ++i, ++block_number) {
    Frame<T>& X = i < machine.nodes ? at(work.state.nodes, i) : work.state.platform;
    const double* frame = &at(cell.state, machine.joints + 12 * i);
    const Block<T> way = sum(cell.changes, block_number, terms);
    Mat3<T> R;
    for (int k = 0; k < 9; ++k) R.c[k] = all<T>(frame[k]);
    R = exp_so3(Vec3<T>{{way.value[3], way.value[4], way.value[5]}}) * R;
    for (int k = 0; k < 9; ++k) put(R.c[k], X.R.c[k]);
    for (int k = 0; k < 3; ++k) put(frame[9 + k] - work.origin[k] + way.value[k], X.p[k]);
  }
  if (cell.stress.empty()) return;
  TermValues<T> of_stress;
  fill(cell.stress_changes, x, terms.acting, of_stress);
  for (int i = 0; i < static_cast<int>(machine.elements.size()); ++i) {
    if (at(machine.elements, i).kind == ElementKind::group) continue;
    const Block<T> change = sum(cell.stress_changes, i, of_stress);
    Vec6<T>& stress = at(work.start_stress, i);
    for (int k = 0; k < 3; ++k) {
      put(at(cell.stress, block * i + k) + change.value[k], stress.v[k]);
      put(at(cell.stress, block * i + 3 + k) + change.value[3 + k], stress.w[k]);
    }
  }
}

/// From the wanted tip to the variables of a cell of one machine, without loads.
template <class T>
COUNTERFLEX_INLINE Point<T> find_place(const StartCell& cell, const Work<T>& work) {
  Point<T> x;
  for (int i = 0; i < 3; ++i) x[i] = work.origin[i] - at(cell.centre, i);
  if (!cell.variables.turns) return x;
  Mat3<T> R;
  for (int i = 0; i < 9; ++i) R.c[i] = all<T>(at(cell.R, i));
  const Vec3<T> turn = log_so3(times_transposed(work.wanted_R, R));
  for (int i = 0; i < 3; ++i) x[3 + i] = turn[i];
  return x;
}

/// The offset from the tip to the command that a target's cell has, `terms` being those of its changes: the
/// block behind those of the state.
template <class T>
COUNTERFLEX_INLINE Block<T> command_offset(const StartCell& cell, const FlatMachine& machine,
                                           const TermValues<T>& terms) {
  Block<T> offset = sum(cell.changes, (machine.joints + block - 1) / block + machine.nodes + 1, terms);
  for (int i = 0; i < block; ++i) offset.value[i] += at(cell.offset, i);
  return offset;
}

/// Begins the real machine at the state that a cell has for its lanes. Where a component is commanded, the
/// tip is found from the command: each round leaves some hundredths of the error. Finds the way from the
/// wanted tip to the nominal one.
template <class T>
void put_real_from_cell(const StartCell& cell, const Mask<T>& lanes, Coupled<T>& coupled, T* nominal_way) {
  Work<T>& work = coupled.real;
  const Variables& variables = cell.variables;
  const auto& of_command = coupled.problem.of_command;
  Point<T> place = find_place(cell, work);
  Acting acting = Acting::nothing;
  for (int i = 0; i < 6 && variables.loads; ++i) {
    T& load = place[variables.first_load() + i];
    load = (i < 3 ? work.load.v[i] : work.load.w[i - 3]) * work.question.load;
    if (any<T>(load != 0.0)) acting = i < 3 ? Acting::force : Acting::moment;
  }
  Point<T> x = place;
  TermValues<T> terms;
  fill(cell.changes, x, acting, terms);
  bool is_commanded = false;
  const int components = variables.first_load();
  for (int j = 0; j < components; ++j) is_commanded = is_commanded || at(of_command, j);
  const int rounds = !is_commanded ? 1 : of_command[0] ? 3 : 2;  // an orientation changes the offset less
  for (int k = 0; k < rounds; ++k) {
    const Block<T> offset = command_offset(cell, work.machine, terms);
    for (int j = 0; j < components; ++j)
      if (at(of_command, j))
        x[j] = place[j] - offset.value[j];
      else
        nominal_way[j] = select<T>(lanes, offset.value[j], nominal_way[j]);
    if (is_commanded) fill(cell.changes, x, acting, terms);
  }
  put_state_of_cell(cell, lanes, x, terms, work);
}

/// Begins both machines at the states that the cells have for the waypoints from `first` on.
template <class T>
void put_from_cells(const Batch& batch, int first, Coupled<T>& coupled) {
  const Problem& problem = coupled.problem;
  T nominal_way[6]{};
  if (problem.real)
    for_each_cell<T>(batch, first, batch.cells, [&](const StartCell& cell, const Mask<T>& lanes) {
      put_real_from_cell<T>(cell, lanes, coupled, nominal_way);
    });
  if (problem.nominal)
    for_each_cell<T>(batch, first, batch.nominal_cells, [&](const StartCell& cell, const Mask<T>& lanes) {
      Point<T> x = find_place(cell, coupled.nominal);
      for (int i = 0; i < 6; ++i) x[i] += nominal_way[i];
      TermValues<T> terms;
      fill(cell.changes, x, Acting::nothing, terms);
      put_state_of_cell<T>(cell, lanes, x, terms, coupled.nominal);
    });
}

/// Bounds for first steps that begin in cells: they grow with the load.
template <class T>
T contraction_of_cells(const Batch& batch, int first, const Work<T>& work) {
  const Vec3<T> force = work.load.v * work.question.load,
                moment = work.load.w * (work.question.load / work.machine.length);
  const T moment_squared = dot(moment, moment), size_squared = dot(force, force) + moment_squared;
  return gather<T>([&](int l) {
    const auto& [unloaded, by_force, by_moment] = at(batch.cells, waypoint_of(batch, first, l))->contraction;
    const double loaded = lane(moment_squared, l) > 0 ? by_moment : by_force;
    return unloaded + std::sqrt(lane(size_squared, l)) / load_of_cells * (loaded - unloaded);
  });
}

}  // namespace counterflex::kernel
