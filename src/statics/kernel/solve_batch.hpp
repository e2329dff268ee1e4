#pragma once
/// A batch through the lanes of one instance.
#include <limits>

#include "statics/kernel/cells/from_cells.hpp"

namespace counterflex::kernel {

/// A joint that slides needs no cosine and sine.
template <class T>
COUNTERFLEX_INLINE void put_joint(int l, double q, bool turns, JointState<T>& joint) {
  lane(joint.q, l) = q;
  if (!turns) return;
  lane(joint.cosine, l) = std::cos(q);
  lane(joint.sine, l) = std::sin(q);
}

template <class T>
void put_state(const FlatMachine& machine, int l, const double* numbers, Work<T>& work) {
  for (int j = 0; j < machine.joints; ++j, ++numbers)
    put_joint(l, *numbers, at(machine.joint_turns, j) != 0, at(work.state.joints, j));
  const auto put = [&](Frame<T>& X) {
    for (int i = 0; i < 9; ++i) lane(X.R.c[i], l) = *numbers++;
    for (int i = 0; i < 3; ++i) lane(X.p[i], l) = *numbers++ - lane(work.origin[i], l);
  };
  for (Frame<T>& node : work.state.nodes) put(node);
  put(work.state.platform);
}

template <class T>
void get_state(int l, const Work<T>& work, double* numbers) {
  for (const JointState<T>& joint : work.state.joints) *numbers++ = lane(joint.q, l);
  const auto get = [&](const Frame<T>& X) {
    for (int i = 0; i < 9; ++i) *numbers++ = lane(X.R.c[i], l);
    for (int i = 0; i < 3; ++i) *numbers++ = lane(X.p[i], l) + lane(work.origin[i], l);
  };
  for (const Frame<T>& node : work.state.nodes) get(node);
  get(work.state.platform);
}

/// Of every spring the wrench `of(terms)` about its end; of groups zero.
template <class T, class Of>
void get_wrenches(int l, const Work<T>& work, double* numbers, const Of& of) {
  for (std::size_t i = 0; i < work.machine.elements.size(); ++i, numbers += 6) {
    const ElementTerms<T>& terms = work.equations.elements[i];
    const Vec6<T> wrench = of(terms);
    const Vec3<T> own = wrench.w - cross(terms.p, wrench.v);
    const bool spring = work.machine.elements[i].kind == ElementKind::spring;
    for (int k = 0; k < 3; ++k) {
      numbers[k] = spring ? lane(wrench.v[k], l) : 0;
      numbers[3 + k] = spring ? lane(own[k], l) : 0;
    }
  }
}

/// From states of each waypoint, or from one of all.
template <class T>
void put_states(const Batch& batch, int first, const std::vector<double>& states, Work<T>& work) {
  const int size = work.machine.state_size();
  const bool has_one = static_cast<int>(states.size()) == size;
  for (int l = 0; l < lane_count<T>; ++l)
    put_state(work.machine, l, states.data() + (has_one ? 0 : size * waypoint_of(batch, first, l)), work);
}

/// Fills the lanes of a machine with waypoints from `first` on.
template <class T>
void put_waypoints(const Batch& batch, int first, Work<T>& work) {
  for (int l = 0; l < lane_count<T>; ++l) {
    const int w = waypoint_of(batch, first, l);
    for (int i = 0; i < 3; ++i) lane(work.origin[i], l) = at(batch.p, 3 * w + i);
    for (int i = 0; i < 6; ++i) lane(work.load[i], l) = batch.F.empty() ? 0 : at(batch.F, 6 * w + i);
    for (int i = 0; i < 9; ++i) lane(work.wanted_R.c[i], l) = batch.R.empty() ? 0 : at(batch.R, 9 * w + i);
  }
}

/// What the joint of an actuator has more than the commanded value.
template <class T>
double actuator_offset(int a, int l, const Work<T>& work) {
  const double offset = work.question.gravity * at(work.machine.actuator_offset, a);
  return work.lag.empty() ? offset : offset + lane(at(work.lag, a), l);
}

template <class T>
void put_actuator(int a, int l, double rho, Work<T>& work) {
  const int j = at(work.machine.actuator_joint, a);
  put_joint(l, rho + actuator_offset(a, l, work), at(work.machine.joint_turns, j) != 0,
            at(work.state.joints, j));
}

template <class T>
double get_actuator(int a, int l, const Work<T>& work) {
  return lane(at(work.state.joints, at(work.machine.actuator_joint, a)).q, l) - actuator_offset(a, l, work);
}

/// The lags of waypoints from `first` on.
template <class T>
void put_lags(const Batch& batch, int first, Work<T>& real) {
  real.lag.resize(batch.lag.empty() ? 0 : real.machine.actuator_joint.size());
  const int actuators = static_cast<int>(real.lag.size());
  for (int a = 0; a < actuators; ++a)
    at(real.lag, a) =
        gather<T>([&](int l) { return at(batch.lag, actuators * waypoint_of(batch, first, l) + a); });
}

/// The machine has the actuators of the other one.
template <class T>
void copy_actuators(const Work<T>& from, Work<T>& to) {
  const FlatMachine& machine = to.machine;
  for (int a = 0; a < static_cast<int>(machine.actuator_joint.size()); ++a) {
    at(to.state.joints, at(machine.actuator_joint, a)) =
        at(from.state.joints, at(from.machine.actuator_joint, a));
    const bool same = at(machine.actuator_offset, a) == 0 || from.question.gravity == to.question.gravity;
    if (same && from.lag.empty() && to.lag.empty()) continue;
    for (int l = 0; l < lane_count<T>; ++l) put_actuator(a, l, get_actuator(a, l, from), to);
  }
}

/// The real machine has the actuators of the batch where these are held.
template <class T>
void put_held_actuators(const Batch& batch, int first, Work<T>& real) {
  const int actuators = static_cast<int>(real.machine.actuator_joint.size());
  for (int l = 0; l < lane_count<T>; ++l) {
    const int w = waypoint_of(batch, first, l);
    for (int a = 0; a < actuators; ++a) put_actuator(a, l, at(batch.rho, actuators * w + a), real);
  }
}

template <class T>
void get_tip(int l, const Work<T>& work, double* numbers) {
  for (int i = 0; i < 9; ++i) numbers[i] = lane(work.equations.tip.R.c[i], l);
  for (int i = 0; i < 3; ++i) numbers[9 + i] = lane(work.equations.tip.p[i], l) + lane(work.origin[i], l);
}

template <class T>
void get_pivots(Batch& batch, int first, const Work<T>& work) {
  const int count = work.machine.unknowns();
  visit_pivots(work, [&](int i, const T& inverse) {
    for (int l = 0; l < lane_count<T> && first + l < batch.count(); ++l)
      at(batch.pivots, count * (first + l) + i) = lane(inverse, l) == 0 ? 0 : 1 / lane(inverse, l);
  });
}

/// Whether pivots have the sign of their cell's, and enough of its size. Joints that turn freely in the cell
/// do not count.
template <class T>
Mask<T> keeps_pivots(const Batch& batch, int first, const Work<T>& work) {
  const auto cell_of = [&](int l) -> const StartCell& {
    return *at(batch.cells, waypoint_of(batch, first, l));
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

/// First derivatives at the solution: steps of the linearised equations, whose residuals are those of a unit
/// change.
template <class T>
void get_responses(Batch& batch, int first, Coupled<T>& coupled) {
  const long size = coupled.problem.machine().unknowns() + (coupled.problem.real ? 6 : 0);
  const int variables = batch.response_to->count();
  const long of_elements = 6 * static_cast<long>(coupled.real.machine.elements.size());
  coupled.for_each([](Work<T>& work) {
    Equations<T>& equations = work.equations;
    for (JointTerms<T>& joint : equations.joints) joint.r = T{};
    for (Vec6<T>& node : equations.nodes) node = {};
    equations.platform = equations.tip_error = {};
    work.predicts_stress = true;
  });
  for (int k = 0; k < variables; ++k) {
    const int load = k - batch.response_to->first_load();
    Equations<T>& changed = load < 0 ? coupled.owner(k).equations : coupled.real.equations;
    Vec6<T> change{};
    const int component = load < 0 ? k : load;
    (component < 3 ? change.v[component] : change.w[component - 3]) = all<T>(1);
    if (load < 0)
      changed.tip_error = change;
    else
      changed.platform = Vec6<T>{change.v, change.w + cross(arm_of_load(coupled.real), change.v)} * -1.0;
    find_step(coupled);
    changed.tip_error = changed.platform = {};
    const Work<T>& work = coupled.first();
    for (int l = 0; l < lane_count<T> && first + l < batch.count(); ++l) {
      const long number = static_cast<long>(variables) * (first + l) + k;
      if (coupled.problem.real)
        get_wrenches(l, work, batch.stress_responses.data() + of_elements * number,
                     [](const ElementTerms<T>& terms) { return terms.stress - terms.phi; });
      double* numbers = batch.responses.data() + size * number;
      const auto put = [&](const Vec6<T>& twist) {
        for (int i = 0; i < 3; ++i) *numbers++ = lane(twist.v[i], l);
        for (int i = 0; i < 3; ++i) *numbers++ = lane(twist.w[i], l);
      };
      for (const JointTerms<T>& joint : work.equations.joints) *numbers++ = lane(joint.y, l);
      for (const Vec6<T>& node : work.step.nodes) put(node);
      put(work.step.platform);
      if (coupled.problem.real) put(coupled.nominal.step.platform);
    }
  }
}

/// Solves the phases of the problem one after the other; the lanes that are accepted in all of them.
template <class T>
Solved<T> solve_phases(const Schedule& schedule, const Batch& batch, int first, Coupled<T>& coupled,
                       Mask<T>& is_stiff) {
  const std::vector<Phase>& phases = coupled.phases;
  Solved<T> solved{is_stiff, {}, {}};
  for (std::size_t k = 0; k < phases.size(); ++k) {
    coupled.begin(phases[k]);
    if (k > 0 && phases[k].real) copy_actuators(coupled.nominal, coupled.real);
    if (k > 0 && phases[k].nominal) copy_actuators(coupled.real, coupled.nominal);
    const T contraction = phases[k].real && !batch.cells.empty()
                              ? contraction_of_cells<T>(batch, first, coupled.real)
                              : all<T>(std::numeric_limits<double>::infinity());
    const Solved<T> here =
        iterate<T>(schedule, solved.accepted, contraction, coupled, [&](const Mask<T>& active) {
          if (batch.cells.empty() || !phases[k].real) return;
          const Mask<T> keeps = keeps_pivots(batch, first, coupled.real), done = opposite<T>(active);
          is_stiff = (is_stiff & done) | (keeps & active);
        });
    solved.accepted = here.accepted;
    solved.iterations = larger(solved.iterations, here.iterations);
    if (phases[k].real) solved.contraction = here.contraction;
  }
  return solved;
}

template <class T>
std::unique_ptr<Memory> memory_of(const Problem& problem) {
  return std::make_unique<Coupled<T>>(problem);
}

/// `memory`: a Coupled<T>.
template <class T>
void solve_batch(Memory& memory, const Schedule& schedule, Batch& batch) {
  auto& coupled = static_cast<Coupled<T>&>(memory);
  const Problem& problem = coupled.problem;
  const FlatMachine& machine = problem.machine();
  const Phase whole{problem.real.has_value(), problem.nominal.has_value(), problem.nominal.has_value()};
  const int actuators = static_cast<int>(machine.actuator_joint.size());
  for (int first = 0; first < batch.count(); first += lane_count<T>) {
    coupled.begin(whole);
    const Work<T>& first_work = coupled.first();
    coupled.for_each([&](Work<T>& work) { put_waypoints(batch, first, work); });
    put_lags(batch, first, coupled.real);
    const bool has_cells = batch.start.empty() && batch.nominal_start.empty();
    if (has_cells) put_from_cells(batch, first, coupled);
    if (!has_cells && problem.real) put_states(batch, first, batch.start, coupled.real);
    if (!has_cells && problem.nominal) put_states(batch, first, batch.nominal_start, coupled.nominal);
    if (!problem.nominal)
      put_held_actuators(batch, first, coupled.real);
    else if (coupled.phases.front().real && coupled.phases.front().nominal)
      copy_actuators(coupled.nominal, coupled.real);
    Mask<T> is_stiff = first_work.origin[0] == first_work.origin[0];
    const Solved<T> solved = solve_phases(schedule, batch, first, coupled, is_stiff);
    coupled.begin(whole);
    for (int l = 0; l < lane_count<T> && first + l < batch.count(); ++l) {
      const int w = first + l;
      at(batch.accepted, w) = lane_of_mask<T>(solved.accepted, l);
      at(batch.is_stiff, w) = lane_of_mask<T>(is_stiff, l);
      at(batch.contraction, w) = lane(solved.contraction, l);
      at(batch.iterations, w) = static_cast<int>(lane(solved.iterations, l));
      for (int a = 0; a < actuators; ++a)
        at(batch.actuators, actuators * w + a) = get_actuator(a, l, first_work);
      if (problem.real) get_tip(l, coupled.real, batch.tip.data() + 12 * w);
      if (problem.nominal) get_tip(l, coupled.nominal, batch.nominal_tip.data() + 12 * w);
      if (!batch.wants_states) continue;
      get_state(l, first_work, batch.state.data() + static_cast<long>(machine.state_size()) * w);
      get_wrenches(l, first_work, batch.stress.data() + 6 * static_cast<long>(machine.elements.size()) * w,
                   [](const ElementTerms<T>& terms) { return terms.phi; });
    }
    if (!batch.wants_pivots && !batch.response_to) continue;
    factor_at_solution(coupled);
    if (batch.wants_pivots) get_pivots(batch, first, coupled.first());
    if (batch.response_to) get_responses(batch, first, coupled);
  }
}

}  // namespace counterflex::kernel
