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
  const StartCell* const* const cells = work.question.nominal ? batch.nominal_cells : batch.cells;
  const double* const places = work.question.nominal ? batch.nominal_place : batch.place;
  const auto cell_of = [&](int l) { return cells[first + l < batch.count ? first + l : batch.count - 1]; };
  const StartCell& only = *cell_of(0);
  bool shared = true;
  for (int l = 1; l < lane_count<T>; ++l) shared = shared && cell_of(l) == &only;
  const auto number = [&](auto of, int i) {
    return shared ? all<T>(at(only.*of, i)) : gather<T>([&](int l) { return at(cell_of(l)->*of, i); });
  };
  const auto place = [&](int l, int i) {
    const int w = first + l < batch.count ? first + l : batch.count - 1;
    return places != nullptr ? places[6 * w + i] : i < 3 ? batch.p[3 * w + i] : 0;
  };
  T x[StartCell::most_terms];
  for (int i = 0; i < 3; ++i) x[i] = gather<T>([&](int l) { return place(l, i) - at(cell_of(l)->centre, i); });
  x[3] = x[0] * x[0], x[4] = x[1] * x[1], x[5] = x[2] * x[2];
  x[6] = x[0] * x[1], x[7] = x[0] * x[2], x[8] = x[1] * x[2];
  int terms = StartCell::position_terms;
  for (int i = 3; i < 6 && only.turns; ++i) x[terms++] = gather<T>([&](int l) { return place(l, i); });
  T load[6];
  COUNTERFLEX_UNROLL
  for (int i = 0; i < 6; ++i) load[i] = work.load[i] * work.question.load;
  for (int i = 0; i < 6 && only.loads; ++i) x[terms++] = load[i];
  const auto change = [&](int unknown) {
    T sum{};
    for (int k = 0; k < terms; ++k) sum += number(&StartCell::changes, terms * unknown + k) * x[k];
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

/// Fills the lanes of a machine with waypoints from `first` on; the last waypoint stands in for those that are
/// not there.
template <class T>
void put_waypoints(const Batch& batch, int first, Work<T>& work) {
  for (int l = 0; l < lane_count<T>; ++l) {
    const int w = first + l < batch.count ? first + l : batch.count - 1;
    for (int i = 0; i < 3; ++i) lane(work.origin[i], l) = batch.p[3 * w + i];
    for (int i = 0; i < 6 && batch.F != nullptr; ++i) lane(work.load[i], l) = batch.F[6 * w + i];
    if (batch.R != nullptr)
      for (int i = 0; i < 9; ++i) lane(work.wanted_R.c[i], l) = batch.R[9 * w + i];
    if (batch.start != nullptr) put_state(work.machine, l, batch.start + batch.start_stride * w, work);
  }
  if (batch.start == nullptr) put_from_cells(batch, first, work);
}

template <class T>
void put_actuator(int a, int l, double rho, Work<T>& work) {
  const int j = at(work.machine.actuator_joint, a);
  const double q = rho + work.question.gravity * at(work.machine.actuator_offset, a);
  lane(at(work.state.q, j), l) = q;
  lane(at(work.state.cosine, j), l) = std::cos(q);
  lane(at(work.state.sine, j), l) = std::sin(q);
}

template <class T>
double get_actuator(int a, int l, const Work<T>& work) {
  return lane(at(work.state.q, at(work.machine.actuator_joint, a)), l) -
         work.question.gravity * at(work.machine.actuator_offset, a);
}

/// Both machines have the actuators of the batch where these are held, else those with which the nominal one
/// begins.
template <class T>
void put_actuators(const Batch& batch, int first, Coupled<T>& coupled) {
  const int actuators = static_cast<int>(coupled.real.machine.actuator_joint.size());
  if (!coupled.problem.real) return;
  for (int l = 0; l < lane_count<T>; ++l) {
    const int w = first + l < batch.count ? first + l : batch.count - 1;
    for (int a = 0; a < actuators; ++a)
      put_actuator(a, l, coupled.problem.nominal ? get_actuator(a, l, coupled.nominal) : batch.rho[actuators * w + a],
                   coupled.real);
  }
}

template <class T>
void get_tip(int l, const Work<T>& work, double* numbers) {
  for (int i = 0; i < 9; ++i) numbers[i] = lane(work.equations.tip.R.c[i], l);
  for (int i = 0; i < 3; ++i) numbers[9 + i] = lane(work.equations.tip.p[i], l) + lane(work.origin[i], l);
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
Mask<T> keeps_pivots(const Batch& batch, int first, const Work<T>& work) {
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
  return (least > 0.0) & (most * least_stiffness <= 1.0);
}

template <class T>
void solve_batch(const FlatMachine& machine, const Problem& problem, const Schedule& schedule, Batch& batch) {
  Coupled<T> coupled(machine, problem);
  const Work<T>& first_work = coupled.first();
  const int actuators = static_cast<int>(machine.actuator_joint.size());
  for (int first = 0; first < batch.count; first += lane_count<T>) {
    coupled.for_each([&](Work<T>& work) { put_waypoints(batch, first, work); });
    put_actuators(batch, first, coupled);
    const Mask<T> all_lanes = first_work.origin[0] == first_work.origin[0];
    Mask<T> is_stiff = all_lanes;
    const Solved<T> solved = iterate<T>(schedule, all_lanes, coupled, [&](const Mask<T>& active) {
      if (batch.is_stiff == nullptr) return;
      const Mask<T> keeps = keeps_pivots(batch, first, coupled.real), done = opposite<T>(active);
      is_stiff = (is_stiff & done) | (keeps & active);
    });
    for (int l = 0; l < lane_count<T> && first + l < batch.count; ++l) {
      const int w = first + l;
      batch.accepted[w] = lane_of_mask<T>(solved.accepted, l);
      if (batch.is_stiff != nullptr) batch.is_stiff[w] = lane_of_mask<T>(is_stiff, l);
      if (batch.iterations != nullptr) batch.iterations[w] = static_cast<int>(lane(solved.iterations, l));
      for (int a = 0; a < actuators && batch.actuators != nullptr; ++a)
        batch.actuators[actuators * w + a] = get_actuator(a, l, first_work);
      if (batch.tip != nullptr) get_tip(l, coupled.real, batch.tip + 12 * w);
      if (batch.nominal_tip != nullptr) get_tip(l, coupled.nominal, batch.nominal_tip + 12 * w);
      if (batch.state != nullptr)
        get_state(l, first_work, batch.state + static_cast<long>(machine.state_size()) * w);
      if (batch.stress != nullptr)
        get_stress(l, first_work, batch.stress + 6 * static_cast<long>(machine.elements.size()) * w);
    }
    if (!problem.real || batch.pivots == nullptr) continue;
    factor_at_solution(coupled.real);
    get_pivots(batch, first, coupled.real);
  }
}

}  // namespace counterflex::kernel
