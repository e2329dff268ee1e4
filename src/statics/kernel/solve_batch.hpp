#pragma once
/// A batch through the lanes of one instance.
#include "batch.hpp"
#include "newton.hpp"

namespace counterflex::kernel {

template <class T>
void put_state(const FlatMachine& machine, int l, const double* numbers, Work<T>& work) {
  for (int j = 0; j < machine.joints; ++j, ++numbers) {
    lane(at(work.state.q, j), l) = *numbers;
    lane(at(work.state.cosine, j), l) = std::cos(*numbers);
    lane(at(work.state.sine, j), l) = std::sin(*numbers);
  }
  const auto put = [&](Frame<T>& X) {
    for (int i = 0; i < 9; ++i) lane(X.R.c[i], l) = *numbers++;
    for (int i = 0; i < 3; ++i) lane(X.p[i], l) = *numbers++ - lane(work.origin[i], l);
  };
  for (Frame<T>& node : work.state.nodes) put(node);
  put(work.state.platform);
}

template <class T>
void get_state(int l, const Work<T>& work, double* numbers) {
  for (const T& q : work.state.q) *numbers++ = lane(q, l);
  const auto get = [&](const Frame<T>& X) {
    for (int i = 0; i < 9; ++i) *numbers++ = lane(X.R.c[i], l);
    for (int i = 0; i < 3; ++i) *numbers++ = lane(X.p[i], l) + lane(work.origin[i], l);
  };
  for (const Frame<T>& node : work.state.nodes) get(node);
  get(work.state.platform);
}

template <class T>
void get_stress(int l, const Work<T>& work, double* numbers) {
  for (std::size_t i = 0; i < work.machine.elements.size(); ++i, numbers += 6) {
    const ElementTerms<T>& terms = work.equations.elements[i];
    const Vec3<T> own = terms.phi.w - cross(terms.p, terms.phi.v);
    const bool spring = work.machine.elements[i].kind == ElementKind::spring;
    for (int k = 0; k < 3; ++k) {
      numbers[k] = spring ? lane(terms.phi.v[k], l) : 0;
      numbers[3 + k] = spring ? lane(own[k], l) : 0;
    }
  }
}

/// The states that the cells have for the waypoints from `first` on.
template <class T>
void put_from_cells(const Batch& batch, int first, Work<T>& work) {
  const FlatMachine& machine = work.machine;
  const auto cell_of = [&](int l) {
    return batch.cells[first + l < batch.count ? first + l : batch.count - 1];
  };
  const StartCell& only = *cell_of(0);
  bool shared = true;
  for (int l = 1; l < lane_count<T>; ++l) shared = shared && cell_of(l) == &only;
  const auto number = [&](auto of, int i) {
    return shared ? all<T>(at(only.*of, i)) : gather<T>([&](int l) { return at(cell_of(l)->*of, i); });
  };
  T x[StartCell::all_terms];
  for (int i = 0; i < 3; ++i)
    x[i] = gather<T>([&](int l) {
      const int w = first + l < batch.count ? first + l : batch.count - 1;
      return (batch.place != nullptr ? batch.place : batch.p)[3 * w + i] - at(cell_of(l)->centre, i);
    });
  x[3] = x[0] * x[0], x[4] = x[1] * x[1], x[5] = x[2] * x[2];
  x[6] = x[0] * x[1], x[7] = x[0] * x[2], x[8] = x[1] * x[2];
  T* const load = x + StartCell::place_terms;
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 6; ++i) load[i] = work.load[i] * work.question.load;
  const auto change = [&](int unknown) {
    T sum{};
    for (int k = 0; k < only.terms; ++k) sum += number(&StartCell::changes, only.terms * unknown + k) * x[k];
    return sum;
  };
  for (int j = 0; j < machine.joints; ++j) {
    at(work.state.q, j) = number(&StartCell::state, j);
    at(work.state.cosine, j) = number(&StartCell::cosine, j);
    at(work.state.sine, j) = number(&StartCell::sine, j);
    move_joint(change(j), at(machine.joint_turns, j) != 0, j, work.state);
  }
  for (int i = 0; i <= machine.nodes; ++i) {
    Frame<T>& X = i < machine.nodes ? at(work.state.nodes, i) : work.state.platform;
    const int frame = machine.joints + 12 * i, row = machine.joints + 6 * i;
    Vec3<T> w;
    Mat3<T> R;
    for (int k = 0; k < 9; ++k) R.c[k] = number(&StartCell::state, frame + k);
    for (int k = 0; k < 3; ++k) {
      X.p[k] = number(&StartCell::state, frame + 9 + k) - work.origin[k] + change(row + k);
      w[k] = change(row + 3 + k);
    }
    X.R = exp_so3(w) * R;
  }
  if (only.stress.empty()) return;
  for (int i = 0; i < static_cast<int>(machine.elements.size()); ++i) {
    T of_element[6];
    for (int k = 0; k < 6; ++k) {
      const int row = StartCell::stress_terms * (6 * i + k);
      of_element[k] = number(&StartCell::stress, row);
      for (int j = 0; j < 6; ++j) of_element[k] += number(&StartCell::stress, row + 1 + j) * load[j];
    }
    at(work.start_stress, i) = {{{of_element[0], of_element[1], of_element[2]}},
                                {{of_element[3], of_element[4], of_element[5]}}};
  }
}

/// Fills the lanes of `work` with waypoints from `first` on; the last waypoint stands in for those that are
/// not there.
template <class T>
void put_waypoints(const Batch& batch, int first, Work<T>& work) {
  const FlatMachine& machine = work.machine;
  for (int l = 0; l < lane_count<T>; ++l) {
    const int w = first + l < batch.count ? first + l : batch.count - 1;
    for (int i = 0; i < 3; ++i) lane(work.origin[i], l) = batch.p[3 * w + i];
    for (int i = 0; i < 6; ++i) lane(work.load[i], l) = batch.F[6 * w + i];
    if (batch.R != nullptr)
      for (int i = 0; i < 9; ++i) lane(work.wanted_R.c[i], l) = batch.R[9 * w + i];
    if (batch.cells == nullptr) put_state(machine, l, batch.start + batch.start_stride * w, work);
  }
  if (batch.cells != nullptr) put_from_cells(batch, first, work);
  for (int l = 0; l < lane_count<T> && !work.question.target; ++l) {
    const int w = first + l < batch.count ? first + l : batch.count - 1;
    for (int a = 0; a < static_cast<int>(machine.actuator_joint.size()); ++a) {
      const int j = at(machine.actuator_joint, a);
      const double q = batch.rho[static_cast<int>(machine.actuator_joint.size()) * w + a] +
                       work.question.gravity * at(machine.actuator_offset, a);
      lane(at(work.state.q, j), l) = q;
      lane(at(work.state.cosine, j), l) = std::cos(q);
      lane(at(work.state.sine, j), l) = std::sin(q);
    }
  }
}

template <class T>
void get_pivots(const Batch& batch, int first, const Work<T>& work) {
  const long count = work.machine.pivots();
  visit_pivots(work, [&](int i, const T& inverse) {
    for (int l = 0; l < lane_count<T> && first + l < batch.count; ++l)
      batch.pivots[count * (first + l) + i] = lane(inverse, l) == 0 ? 0 : 1 / lane(inverse, l);
  });
}

/// Whether pivots have the sign of their cell's, and enough of its size. Joints that turn freely in the cell do
/// not count.
template <class T>
void compare_pivots(const Batch& batch, int first, const Work<T>& work) {
  const auto cell_of = [&](int l) -> const StartCell& {
    return *batch.cells[first + l < batch.count ? first + l : batch.count - 1];
  };
  T least = all<T>(1), most{};
  visit_pivots(work, [&](int i, const T& inverse) {
    const T unloaded = gather<T>([&](int l) { return at(cell_of(l).pivots, i); });
    const T softening = select<T>(unloaded == 0.0, all<T>(1), inverse * unloaded);
    least = smaller(least, softening);
    most = larger(most, softening);
  });
  const Mask<T> is_stiff = (least > 0.0) & (most * least_stiffness <= 1.0);
  for (int l = 0; l < lane_count<T> && first + l < batch.count; ++l)
    batch.is_stiff[first + l] = lane_of_mask<T>(is_stiff, l);
}

template <class T>
void solve_batch(const FlatMachine& machine, const Question& question, const Schedule& schedule,
                 Batch& batch) {
  Work<T> work(machine);
  work.question = question;
  const int actuators = static_cast<int>(machine.actuator_joint.size());
  for (int first = 0; first < batch.count; first += lane_count<T>) {
    put_waypoints(batch, first, work);
    const Solved<T> solved = iterate<T>(schedule, work.origin[0] == work.origin[0], work);
    if (batch.pivots != nullptr || batch.is_stiff != nullptr) factor_at_solution(work);
    if (batch.pivots != nullptr) get_pivots(batch, first, work);
    if (batch.is_stiff != nullptr) compare_pivots(batch, first, work);
    for (int l = 0; l < lane_count<T> && first + l < batch.count; ++l) {
      const int w = first + l;
      batch.accepted[w] = lane_of_mask<T>(solved.accepted, l);
      if (batch.iterations != nullptr) batch.iterations[w] = static_cast<int>(lane(solved.iterations, l));
      if (batch.actuators != nullptr)
        for (int a = 0; a < actuators; ++a)
          batch.actuators[actuators * w + a] = lane(at(work.state.q, at(machine.actuator_joint, a)), l) -
                                               question.gravity * at(machine.actuator_offset, a);
      if (batch.tip != nullptr) {
        for (int i = 0; i < 9; ++i) batch.tip[12 * w + i] = lane(work.equations.tip.R.c[i], l);
        for (int i = 0; i < 3; ++i)
          batch.tip[12 * w + 9 + i] = lane(work.equations.tip.p[i], l) + lane(work.origin[i], l);
      }
      if (batch.state != nullptr)
        get_state(l, work, batch.state + static_cast<long>(machine.state_size()) * w);
      if (batch.stress != nullptr)
        get_stress(l, work, batch.stress + 6 * static_cast<long>(machine.elements.size()) * w);
    }
  }
}

}  // namespace counterflex::kernel
