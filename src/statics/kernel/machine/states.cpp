#include "statics/kernel/machine/states.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "counterflex/geometry/pose.hpp"
#include "statics/kernel/equations/work.hpp"
#include "statics/model/home.hpp"
#include "statics/model/part.hpp"

namespace counterflex::kernel {
namespace {

using ModelSeries = counterflex::Series;

constexpr Stage unloaded{.errors = 0, .load = 0, .preload = 0, .gravity = 0};

/// The states of a series and of the branches inside it, by their number in the flat machine.
template <class State>
void collect(const Flat& flat, const ModelSeries& series, State& state, int s, std::vector<State*>& all) {
  at(all, s) = &state;
  int e = at(flat.machine.series, s).first;
  for (const Part& part : series.parts) {
    if (!is_six(flat, part)) continue;
    const Element& element = at(flat.machine.elements, e++);
    for (int b = 0; b < element.branches; ++b)
      collect(flat, at(at(series.groups, part.group).branches, b),
              at(at(state.groups, part.group).branches, b), element.series + b, all);
  }
}

template <class State, class Chains>
std::vector<State*> all_states(const Mechanism& mechanism, const Flat& flat, Chains& chains) {
  std::vector<State*> all(flat.machine.series.size());
  for (int s = 0; s < flat.machine.chains; ++s)
    collect<State>(flat, at(mechanism.chains, s), at(chains, s), s, all);
  return all;
}

/// What the controller adds to the value of a joint.
double offset_of(const FlatMachine& machine, const Stage& stage, int joint) {
  const int actuator = actuator_of(machine, joint);
  return actuator < 0 ? 0 : stage.gravity * at(machine.actuator_offset, actuator);
}

void put_pose(const Pose& X, double* numbers) {
  for (int i = 0; i < 9; ++i) numbers[i] = X.R(i / 3, i % 3);
  for (int i = 0; i < 3; ++i) numbers[9 + i] = X.p[i];
}

struct Reader {
  const Flat& flat;
  const Stage& stage;
  StateNumbers& numbers;

  double* node(int i) { return numbers.state.data() + flat.machine.joints + 12 * i; }

  void note_nodes(int s, std::size_t part, const Pose& X) {
    for (int i = 0; i < flat.machine.nodes; ++i)
      if (at(flat.nodes, i).series == s && at(flat.nodes, i).index == static_cast<int>(part))
        put_pose(X, node(i));
  }

  void series(const ModelSeries& series, const SeriesState& state, int s, const Pose& X_start,
              const Pose& X_end) {
    int e = at(flat.machine.series, s).first;
    const Vector3 f = X_start.R * state.F.head<3>(), m = X_start.R * state.F.tail<3>();
    const auto put_stress = [&](const Vector3& p) {
      const Vector3 moment = m + (X_end.p - p).cross(f);
      for (int i = 0; i < 3; ++i)
        at(numbers.stress, 6 * e + i) = f[i], at(numbers.stress, 6 * e + 3 + i) = moment[i];
      ++e;
    };
    Pose X = X_start;
    for (std::size_t k = 0; k < series.parts.size(); ++k) {
      const Part& part = series.parts[k];
      note_nodes(s, k, X);
      const Pose X_before = X;
      X = X * part_pose(part, state, stage);
      if (part.kind == PartKind::spring && is_six(flat, part)) put_stress(X.p);
      if (part.kind != PartKind::group) continue;
      const Element& element = at(flat.machine.elements, e++);
      for (int b = 0; b < element.branches; ++b)
        this->series(at(at(series.groups, part.group).branches, b),
                     at(at(state.groups, part.group).branches, b), element.series + b, X_before, X);
    }
    note_nodes(s, series.parts.size(), X);
    const Series& of = at(flat.machine.series, s);
    while (e < of.first + of.count) put_stress(X_end.p);  // a rigid closure
  }
};

struct Writer {
  const Flat& flat;
  const StateNumbers& numbers;
  const Vector3& p;
  const Stage& stage;

  /// The frame where the element that is part `k` ends: passed back to from the next node, or the end.
  Pose end_of(const ModelSeries& series, const SeriesState& state, int s, int k, const Pose& X_end) const {
    int next = static_cast<int>(series.parts.size());
    Pose X = X_end;
    for (int i = 0; i < flat.machine.nodes; ++i) {
      const Flat::Place& node = at(flat.nodes, i);
      if (node.series != s || node.index <= k || node.index >= next) continue;
      next = node.index;
      X = get_pose(numbers.state.data() + flat.machine.joints + 12 * i);
    }
    Pose between;
    for (int i = k + 1; i < next; ++i) between = between * part_pose(at(series.parts, i), state, stage);
    return X * inverse(between);
  }

  void series(const ModelSeries& series, SeriesState& state, int s, const Pose& X_start,
              const Pose& X_end) const {
    int e = at(flat.machine.series, s).first;
    Pose X = X_start;
    for (int k = 0; k < static_cast<int>(series.parts.size()); ++k) {
      const Part& part = at(series.parts, k);
      if (!is_six(flat, part)) {
        X = X * part_pose(part, state, stage);
        continue;
      }
      const Pose X_after = end_of(series, state, s, k, X_end), across = inverse(X) * X_after;
      const Element& element = at(flat.machine.elements, e++);
      if (part.kind == PartKind::spring)
        state.x.segment<6>(part.column) << across.p, counterflex::log_so3(across.R);
      else
        at(state.groups, part.group).X = across;
      for (int b = 0; b < element.branches; ++b)
        this->series(at(at(series.groups, part.group).branches, b),
                     at(at(state.groups, part.group).branches, b), element.series + b, X, X_after);
      X = X_after;
    }
    const double* end = numbers.ends.data() + 6 * s;
    const Vector3 f(end[0], end[1], end[2]), m(end[3], end[4], end[5]);
    state.F << X_start.R.transpose() * f, X_start.R.transpose() * (m - (X_end.p - p).cross(f));
  }
};

}  // namespace

Pose get_pose(const double* numbers) {
  Pose X;
  for (int i = 0; i < 9; ++i) X.R(i / 3, i % 3) = numbers[i];
  for (int i = 0; i < 3; ++i) X.p[i] = numbers[9 + i];
  return X;
}

int actuator_of(const FlatMachine& machine, int joint) {
  const auto found = std::find(machine.actuator_joint.begin(), machine.actuator_joint.end(), joint);
  return found == machine.actuator_joint.end() ? -1
                                               : static_cast<int>(found - machine.actuator_joint.begin());
}

void read_state(const Mechanism& mechanism, const Flat& flat, const Configuration& configuration,
                const Stage& stage, StateNumbers& numbers) {
  const FlatMachine& machine = flat.machine;
  numbers.state.resize(static_cast<std::size_t>(machine.state_size()));
  numbers.stress.assign(6 * machine.elements.size(), 0);
  const auto states = all_states<const SeriesState>(mechanism, flat, configuration.chains);
  numbers.nominal.resize(flat.joints.size());
  for (int j = 0; j < machine.joints; ++j) {
    const auto [series, column] = at(flat.joints, j);
    at(numbers.state, j) = at(states, series)->x[column] + offset_of(machine, stage, j);
    at(numbers.nominal, j) = at(states, series)->x_nominal[column];
  }
  Reader reader{flat, stage, numbers};
  for (int s = 0; s < machine.chains; ++s)
    reader.series(at(mechanism.chains, s), at(configuration.chains, s), s, {}, configuration.X_MP);
  put_pose(configuration.X_MP, reader.node(machine.nodes));
}

void write_state(const Mechanism& mechanism, const Flat& flat, const StateNumbers& numbers, const Vector3& p,
                 const Stage& stage, Configuration& configuration) {
  const FlatMachine& machine = flat.machine;
  const auto states = all_states<SeriesState>(mechanism, flat, configuration.chains);
  for (int j = 0; j < machine.joints; ++j)
    at(states, at(flat.joints, j).series)->x[at(flat.joints, j).index] =
        at(numbers.state, j) - offset_of(machine, stage, j);
  configuration.X_MP = get_pose(numbers.state.data() + machine.joints + 12 * machine.nodes);
  const Writer writer{flat, numbers, p, stage};
  for (int s = 0; s < machine.chains; ++s)
    writer.series(at(mechanism.chains, s), at(configuration.chains, s), s, {}, configuration.X_MP);
}

std::vector<double> state_of(const Mechanism& mechanism, const Flat& flat, const Configuration& configuration,
                             double errors) {
  StateNumbers numbers;
  Stage stage = unloaded;
  stage.errors = errors;
  read_state(mechanism, flat, configuration, stage, numbers);
  return numbers.state;
}

Configuration nominal_of(const Mechanism& mechanism, const Flat& rigid, const double* state,
                         Configuration like) {
  const StateNumbers numbers{.state = {state, state + rigid.machine.state_size()},
                             .ends = std::vector<double>(6 * rigid.machine.series.size())};
  write_state(mechanism, rigid, numbers, Vector3::Zero(), unloaded, like);
  mark_nominal(like);
  return like;
}

}  // namespace counterflex::kernel
