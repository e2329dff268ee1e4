#pragma once
/// Waypoints that begin in cells, in the lanes of one instance. EQUATIONS.md, section 11, "Starts".
#include "newton.hpp"

namespace counterflex::kernel {

/// The cells of the waypoints from `first` on, and their numbers in the lanes. `shared`: all lanes have the
/// same cell.
template <class T, bool shared>
struct CellLanes {
  const StartCell* cells[lane_count<T>];

  const StartCell& only() const { return *cells[0]; }
  COUNTERFLEX_INLINE T number(std::vector<double> StartCell::*of, int i) const {
    if constexpr (shared)
      return all<T>(at(only().*of, i));
    else
      return gather<T>([&](int l) { return at(cells[l]->*of, i); });
  }
  COUNTERFLEX_INLINE Block<T> sum(std::vector<double> StartCell::*of, int number_of_block, int terms,
                                  const T* x) const {
    const int first = block * terms * number_of_block;
    return sum_terms<T>(terms, x, [&](int i) { return number(of, first + i); });
  }
};

/// Calls `visit` with the lanes of `cells`.
template <class T, class Visit>
COUNTERFLEX_INLINE void with_cells(const Batch& batch, int first, const StartCell* const* cells,
                                   const Visit& visit) {
  CellLanes<T, true> same{};
  bool shared = true;
  for (int l = 0; l < lane_count<T>; ++l) {
    same.cells[l] = cells[first + l < batch.count ? first + l : batch.count - 1];
    shared = shared && same.cells[l] == same.cells[0];
  }
  if (shared) return visit(same);
  CellLanes<T, false> different{};
  for (int l = 0; l < lane_count<T>; ++l) different.cells[l] = same.cells[l];
  visit(different);
}

/// The state that cells have for the variables x.
template <class T, bool shared>
void put_state_of_cells(const CellLanes<T, shared>& cells, const T* x, Work<T>& work) {
  const FlatMachine& machine = work.machine;
  const Variables& variables = cells.only().variables;
  const int terms = variables.start_terms();
  T of_terms[most_start_terms];
  fill_start_terms(variables.count(), x, of_terms);
  int number_of_block = 0;
  for (int begin = 0; begin < machine.joints; begin += block, ++number_of_block) {
    const Block<T> dq = cells.sum(&StartCell::changes, number_of_block, terms, of_terms);
    for (int i = 0; i < block && begin + i < machine.joints; ++i) {
      const int j = begin + i;
      at(work.state.q, j) = cells.number(&StartCell::state, j);
      at(work.state.cosine, j) = cells.number(&StartCell::cosine, j);
      at(work.state.sine, j) = cells.number(&StartCell::sine, j);
      move_joint(dq.value[i], at(machine.joint_turns, j) != 0, j, work.state);
    }
  }
  for (int i = 0; i <= machine.nodes; ++i, ++number_of_block) {
    Frame<T>& X = i < machine.nodes ? at(work.state.nodes, i) : work.state.platform;
    const int frame = machine.joints + 12 * i;
    const Block<T> way = cells.sum(&StartCell::changes, number_of_block, terms, of_terms);
    Mat3<T> R;
    for (int k = 0; k < 9; ++k) R.c[k] = cells.number(&StartCell::state, frame + k);
    for (int k = 0; k < 3; ++k)
      X.p[k] = cells.number(&StartCell::state, frame + 9 + k) - work.origin[k] + way.value[k];
    X.R = exp_so3(Vec3<T>{{way.value[3], way.value[4], way.value[5]}}) * R;
  }
  if (cells.only().stress.empty()) return;
  for (int i = 0; i < static_cast<int>(machine.elements.size()); ++i) {
    const Block<T> change = cells.sum(&StartCell::stress_changes, i, variables.count(), x);
    Vec6<T>& stress = at(work.start_stress, i);
    for (int k = 0; k < 3; ++k) {
      stress.v[k] = cells.number(&StartCell::stress, block * i + k) + change.value[k];
      stress.w[k] = cells.number(&StartCell::stress, block * i + 3 + k) + change.value[3 + k];
    }
  }
}

/// From the wanted tip to the variables of the cells of one machine, without loads.
template <class T, bool shared>
COUNTERFLEX_INLINE void find_place(const CellLanes<T, shared>& cells, const Work<T>& work, T* x) {
  for (int i = 0; i < 3; ++i)
    x[i] = work.origin[i] - gather<T>([&](int l) { return at(cells.cells[l]->centre, i); });
  for (int i = 3; i < most_variables; ++i) x[i] = T{};
  if (!cells.only().variables.turns) return;
  Mat3<T> R;
  for (int i = 0; i < 9; ++i) R.c[i] = gather<T>([&](int l) { return at(cells.cells[l]->R, i); });
  const Vec3<T> turn = log_so3(times_transposed(work.wanted_R, R));
  for (int i = 0; i < 3; ++i) x[3 + i] = turn[i];
}

/// The offset from the tip to the command that cells have for the variables x.
template <class T, bool shared>
Block<T> command_offset(const CellLanes<T, shared>& cells, const T* x) {
  const Variables& variables = cells.only().variables;
  T terms[most_start_terms];
  fill_start_terms(variables.count(), x, terms);
  Block<T> offset = cells.sum(&StartCell::offset_changes, 0, variables.start_terms(), terms);
  for (int i = 0; i < block; ++i)
    offset.value[i] += gather<T>([&](int l) { return at(cells.cells[l]->offset, i); });
  return offset;
}

/// Begins both machines at the states that the cells have for the waypoints from `first` on. Where a
/// component is commanded, the tip is found from the command: each round leaves some hundredths of the error.
template <class T>
void put_from_cells(const Batch& batch, int first, Coupled<T>& coupled) {
  const Problem& problem = coupled.problem;
  T nominal_way[6]{};  // from the wanted tip to the nominal one
  if (problem.real)
    with_cells<T>(batch, first, batch.cells, [&](const auto& cells) {
      Work<T>& work = coupled.real;
      const Variables& variables = cells.only().variables;
      T x[most_variables], place[most_variables];
      find_place(cells, work, place);
      for (int i = 0; i < 3 && variables.loads; ++i) {
        place[variables.first_load() + i] = work.load.v[i] * work.question.load;
        place[variables.first_load() + 3 + i] = work.load.w[i] * work.question.load;
      }
      for (int i = 0; i < most_variables; ++i) x[i] = place[i];
      bool is_commanded = false;
      const int components = variables.first_load();
      for (int j = 0; j < components; ++j) is_commanded = is_commanded || at(problem.of_command, j);
      const int rounds = !is_commanded               ? 1
                         : at(problem.of_command, 0) ? 3
                                                     : 2;  // an orientation changes the offset less
      for (int k = 0; k < rounds; ++k) {
        const Block<T> offset = command_offset(cells, x);
        for (int j = 0; j < components; ++j)
          if (at(problem.of_command, j))
            x[j] = place[j] - offset.value[j];
          else
            nominal_way[j] = offset.value[j];
      }
      put_state_of_cells(cells, x, work);
    });
  if (problem.nominal)
    with_cells<T>(batch, first, batch.nominal_cells, [&](const auto& cells) {
      T x[most_variables];
      find_place(cells, coupled.nominal, x);
      for (int i = 0; i < 6; ++i) x[i] += nominal_way[i];
      put_state_of_cells(cells, x, coupled.nominal);
    });
}

/// Bounds for first steps that begin in cells.
template <class T>
T contraction_of_cells(const Batch& batch, int first) {
  return gather<T>(
      [&](int l) { return batch.cells[first + l < batch.count ? first + l : batch.count - 1]->contraction; });
}

}  // namespace counterflex::kernel
