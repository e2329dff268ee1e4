#include "lane_model.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <utility>

namespace counterflex {
namespace {

void collect(const SeriesView& view, std::vector<SeriesView>& list) {
  for (std::size_t g = 0; g < view.series->groups.size(); ++g) {
    std::vector<SeriesView> branches;
    for (std::size_t b = 0; b < view.series->groups[g].branches.size(); ++b) {
      const GroupState& group = view.state->groups[g];
      branches.push_back(
          {&view.series->groups[g].branches[b], &group.branches[b], &view.work->groups[g][b], &group.X, false});
      collect(branches.back(), list);
    }
    list.insert(list.end(), branches.begin(), branches.end());
  }
}

// The states of the same series, in the order of `views`.
template <class State>
void collect_states(State& state, std::vector<State*>& list) {
  for (auto& group : state.groups) {
    for (State& branch : group.branches) collect_states(branch, list);
    for (State& branch : group.branches) list.push_back(&branch);
  }
}

template <class State>
std::vector<State*> states_of(auto& chains) {
  std::vector<State*> list;
  for (State& chain : chains) {
    collect_states(chain, list);
    list.push_back(&chain);
  }
  return list;
}

void put(const Pose& X, double* into) {
  for (int i = 0; i < 9; ++i) into[i] = X.R(i / 3, i % 3);
  for (int i = 0; i < 3; ++i) into[9 + i] = X.p[i];
}

Pose pose_at(const double* from) {
  Pose X;
  for (int i = 0; i < 9; ++i) X.R(i / 3, i % 3) = from[i];
  for (int i = 0; i < 3; ++i) X.p[i] = from[9 + i];
  return X;
}

lanes::FixedPose flat_pose(const Pose& X) {
  lanes::FixedPose flat{};
  for (int i = 0; i < 9; ++i) flat.R[i] = X.R(i / 3, i % 3);
  for (int i = 0; i < 3; ++i) flat.p[i] = X.p[i];
  flat.turns = X.R != Matrix3::Identity();
  flat.shifts = !X.p.isZero(0);
  return flat;
}

// The coordinate axis that `axis` is, with its sign; none: -1.
int coordinate_axis(const Vector3& axis, double& sign) {
  for (int i = 0; i < 3; ++i)
    for (double s : {1.0, -1.0})
      if (axis == s * Vector3::Unit(i)) {
        sign = s;
        return i;
      }
  return -1;
}

// A rotation that takes z to a unit vector that is no coordinate axis.
Matrix3 z_to(const Vector3& axis) {
  Matrix3 R;
  R.col(2) = axis;
  R.col(0) = Vector3::UnitZ().cross(axis).normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  return R;
}

// The row of a part's first coordinate in its series' equations; -1 for an actuator.
int row_of(const Series& series, const Part& part) {
  const auto at = std::find(series.free.begin(), series.free.end(), part.column);
  return at == series.free.end() ? -1 : 6 + static_cast<int>(at - series.free.begin());
}

}  // namespace

std::vector<SeriesView> views(const Mechanism& mechanism, const Configuration& configuration, std::vector<SeriesWork>& works) {
  std::vector<SeriesView> list;
  for (std::size_t i = 0; i < mechanism.chains.size(); ++i) {
    const SeriesView chain{&mechanism.chains[i], &configuration.chains[i], &works[i], &configuration.X_MP, true};
    collect(chain, list);
    list.push_back(chain);
  }
  return list;
}

// With the branches of their groups.
int series_count(const std::vector<Series>& list) {
  int count = static_cast<int>(list.size());
  for (const Series& series : list)
    for (const SeriesGroup& group : series.groups) count += series_count(group.branches);
  return count;
}

bool LaneModel::can_do(const Mechanism& mechanism) {
  const auto controls = [&](Component c) {
    return std::count(mechanism.controlled.begin(), mechanism.controlled.end(), c) > 0;
  };
  return controls(Component::x) && controls(Component::y) && controls(Component::z) &&
         mechanism.travel.size() <= lanes::most_actuators && series_count(mechanism.chains) <= lanes::most_series;
}

// What stands before the next moving part, without and with assembly errors.
struct LaneModel::Standing {
  Pose X[2];
  void add(const Pose& X_fixed) {
    for (Pose& X_sum : X) X_sum = X_sum * X_fixed;
  }
  bool is_identity() const {
    return std::all_of(std::begin(X), std::end(X),
                       [](const Pose& X_sum) { return X_sum.R == Matrix3::Identity() && X_sum.p.isZero(0); });
  }
};

LaneModel::LaneModel(const Model& model, bool at_platform) : model_(model), at_platform_(at_platform) {
  std::vector<SeriesWork> works;
  for (const Series& chain : model.mechanism.chains) works.push_back(make_work(chain));
  const auto list = views(model.mechanism, model.home, works);
  series_.resize(list.size());
  for (const SeriesView& view : list) order_.push_back(view.series);
  for (std::size_t i = 0; i < list.size(); ++i) flatten(*list[i].series, series_[i]);
  program_.platform = program_.states;
  program_.standing = program_.platform + 12;
  program_.states = program_.standing + 4;
  join_ends(list);
  describe_machine();
  place_tangents();
}

// All tangents stand in one block.
void LaneModel::place_tangents() {
  int next = 0;
  const auto take = [&next](int count) { return std::exchange(next, next + count); };
  for (lanes::Series& series : series_) {
    series.inside = take(series.rows * series.rows);
    series.by_end = take(series.rows * 6);
    series.by_actuators = take(series.rows * series.actuators);
  }
  program_.forward = take(6 * 6);
  program_.target = take(9 * 9);
  program_.response = take((program_.rows + 6) * 6);
  program_.tangents = next;
}

// Where chains and branches end, and which branches a group has.
void LaneModel::join_ends(const std::vector<SeriesView>& list) {
  std::map<const Series*, int> number;
  for (std::size_t i = 0; i < list.size(); ++i) number[list[i].series] = static_cast<int>(i);
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i].is_chain) {
      series_[i].is_chain = true;
      series_[i].end = program_.platform;
    } else if (series_[i].mass > 0) {
      program_.branches_weigh = true;
    }
    for (lanes::Part& part : parts_[i]) {
      if (part.operation != lanes::Operation::group) continue;
      const SeriesGroup& group = list[i].series->groups[part.fixed];
      part.first_branch = number.at(&group.branches.front());
      part.branches = static_cast<int>(group.branches.size());
      for (int b = 0; b < part.branches; ++b) series_[part.first_branch + b].end = part.value;
    }
  }
}

void LaneModel::describe_machine() {
  const Mechanism& mechanism = model_.mechanism;
  program_.series = series_.data();
  program_.series_count = static_cast<int>(series_.size());
  program_.fixed[0] = fixed_[0].data();
  program_.fixed[1] = fixed_[1].data();
  program_.actuator_numbers = actuator_numbers_.data();
  program_.actuators = static_cast<int>(mechanism.travel.size());
  program_.length = mechanism.length;
  program_.floor_per_metre = 16 * std::numeric_limits<double>::epsilon() * mechanism.stiffest;
  for (int i = 0; i < 3; ++i) program_.gravity[i] = mechanism.gravity[i];
  const Vector3 arm = at_platform_ ? mechanism.p_EP : mechanism.X_PT.p;
  for (int i = 0; i < 3; ++i) program_.arm[i] = arm[i];
  for (int i = 0; i < 3; ++i) program_.p_PT[i] = mechanism.X_PT.p[i];
  for (int i = 0; i < 9; ++i) program_.R_PT[i] = mechanism.X_PT.R(i / 3, i % 3);
  for (Component c : mechanism.controlled) controlled_.push_back(static_cast<int>(c));
  program_.controlled = controlled_.data();
  const Matrix3 R_MT_home = tip(mechanism, model_.home).R;
  for (int i = 0; i < 9; ++i) program_.R_MT_home[i] = R_MT_home(i / 3, i % 3);
}

// A part for what stands, unless that is nothing.
void LaneModel::put_down(Standing& standing, std::vector<lanes::Part>& parts) {
  if (standing.is_identity()) return;
  fixed_[0].push_back(flat_pose(standing.X[0]));
  fixed_[1].push_back(flat_pose(standing.X[1]));
  const int number = static_cast<int>(fixed_[0].size()) - 1;
  parts.push_back({.operation = lanes::Operation::fixed, .fixed = number, .row = -1, .actuator = -1});
  standing = {};
}

void LaneModel::add_joint(const Part& part, int row, Standing& standing, std::vector<lanes::Part>& parts) {
  const bool slides = part.joint.kind == JointKind::prismatic;
  lanes::Part joint{.operation = slides ? lanes::Operation::slide : lanes::Operation::turn,
                    .value = program_.states++,
                    .row = row,
                    .actuator = part.actuator,
                    .k = part.k,
                    .rest = part.rest,
                    .offset = part.offset,
                    .passive = part.kind == PartKind::passive};
  joint.axis = coordinate_axis(part.joint.axis, joint.sign);
  Matrix3 R_axis = Matrix3::Identity();
  if (joint.axis < 0) {  // about z of a frame that is turned there and back
    R_axis = z_to(part.joint.axis);
    joint.axis = 2;
    joint.sign = 1;
  }
  standing.add(rotation(R_axis));
  put_down(standing, parts);
  parts.push_back(joint);
  standing.add(rotation(R_axis.transpose()));
}

void LaneModel::add_spring(const Part& part, int row, std::vector<lanes::Part>& parts) {
  std::vector<double>& K = springs_.emplace_back();
  for (int i = 0; i < 36; ++i) K.push_back(part.K(i / 6, i % 6));
  for (int i = 0; i < 6; ++i) K.push_back(part.theta_0[i]);
  parts.push_back({.operation = lanes::Operation::spring, .value = program_.states, .row = row, .actuator = -1, .K = K.data()});
  program_.states += 6;
}

void LaneModel::add_mass(const Part& part, Standing& standing, std::vector<lanes::Part>& parts) {
  put_down(standing, parts);
  lanes::Part mass{.operation = lanes::Operation::mass, .row = -1, .actuator = -1, .mass = part.mass};
  for (int i = 0; i < 3; ++i) mass.at[i] = part.X.p[i];
  parts.push_back(mass);
}

// `fixed` says which group it is until `join_ends` knows its branches.
void LaneModel::add_group(const Part& part, int row, std::vector<lanes::Part>& parts) {
  parts.push_back(
      {.operation = lanes::Operation::group, .fixed = part.group, .value = program_.states, .row = row, .actuator = -1});
  program_.states += 12;
}

void LaneModel::flatten(const Series& series, lanes::Series& flat) {
  std::vector<lanes::Part>& parts = parts_.emplace_back();
  Standing standing;
  for (const Part& part : series.parts) {
    const int row = row_of(series, part);
    if (part.kind == PartKind::spring || part.kind == PartKind::group) put_down(standing, parts);
    switch (part.kind) {
      case PartKind::mass: add_mass(part, standing, parts); break;
      case PartKind::fixed: standing.add(part.X); break;
      case PartKind::error: standing.X[1] = standing.X[1] * part.X; break;
      case PartKind::actuator:
      case PartKind::passive:
      case PartKind::compliance: add_joint(part, row, standing, parts); break;
      case PartKind::spring: add_spring(part, row, parts); break;
      case PartKind::group: add_group(part, row, parts); break;
    }
  }
  put_down(standing, parts);
  flat.parts = parts.data();
  flat.part_count = static_cast<int>(parts.size());
  program_.most_parts = std::max(program_.most_parts, flat.part_count);
  number_rows(series, flat);
  flat.mass = series.mass;
}

void LaneModel::number_rows(const Series& series, lanes::Series& flat) {
  flat.rows = 6 + static_cast<int>(series.free.size());
  program_.most_free = std::max(program_.most_free, flat.rows - 6);
  flat.wrench = program_.states;
  program_.states += 6;
  flat.step = program_.rows;
  program_.rows += flat.rows;
  flat.first_actuator = static_cast<int>(actuator_numbers_.size());
  flat.actuators = static_cast<int>(series.actuators.size());
  actuator_numbers_.insert(actuator_numbers_.end(), series.actuators.begin(), series.actuators.end());
  auto& angular = angular_.emplace_back(new bool[series.free.size() + 1]);
  for (std::size_t i = 0; i < series.free.size(); ++i) angular[i] = series.angular[series.free[i]];
  flat.angular = angular.get();
}

// Calls visit(part, flat part) for every part that has coordinates.
template <typename Visit>
void LaneModel::for_each_coordinate(const Series& series, const std::vector<lanes::Part>& parts, const Visit& visit) {
  auto flat = parts.begin();
  for (const Part& part : series.parts) {
    if (part.column < 0) continue;
    while (flat->operation == lanes::Operation::fixed || flat->operation == lanes::Operation::mass) ++flat;
    visit(part, *flat++);
  }
}

std::vector<double> LaneModel::state_of(const Configuration& configuration) const {
  std::vector<double> state(program_.states, 0.0);
  const auto states = states_of<const SeriesState>(configuration.chains);
  for (std::size_t s = 0; s < states.size(); ++s) {
    const SeriesState& from = *states[s];
    for (int i = 0; i < 6; ++i) state[series_[s].wrench + i] = from.F[i];
    for_each_coordinate(*order_[s], parts_[s], [&](const Part& part, const lanes::Part& flat) {
      if (part.kind == PartKind::group) return put(from.groups[part.group].X, &state[flat.value]);
      const int count = part.kind == PartKind::spring ? 6 : 1;
      for (int i = 0; i < count; ++i) state[flat.value + i] = from.x[part.column + i];
    });
  }
  put(configuration.X_MP, &state[program_.platform]);
  return state;
}

std::vector<double> LaneModel::step_between(const std::vector<double>& from, const std::vector<double>& to) const {
  std::vector<double> step(static_cast<std::size_t>(program_.rows) + 6);
  const auto subtract = [&](int row, int value, int count) {
    for (int i = 0; i < count; ++i) step[row + i] = to[value + i] - from[value + i];
  };
  const auto subtract_pose = [&](int row, int value) {
    const Vector6 moved = difference(pose_at(&to[value]), pose_at(&from[value]));
    for (int i = 0; i < 6; ++i) step[row + i] = moved[i];
  };
  for (std::size_t s = 0; s < series_.size(); ++s) {
    subtract(series_[s].step, series_[s].wrench, 6);
    for (const lanes::Part& part : parts_[s]) {
      if (part.row < 0) continue;
      const int row = series_[s].step + part.row;
      if (part.operation == lanes::Operation::group)
        subtract_pose(row, part.value);
      else
        subtract(row, part.value, part.operation == lanes::Operation::spring ? 6 : 1);
    }
  }
  subtract_pose(program_.rows, program_.platform);
  return step;
}

Configuration LaneModel::configuration_of(const double* state, const Configuration& like) const {
  Configuration configuration = like;
  const auto states = states_of<SeriesState>(configuration.chains);
  for (std::size_t s = 0; s < states.size(); ++s) {
    SeriesState& to = *states[s];
    for (int i = 0; i < 6; ++i) to.F[i] = state[series_[s].wrench + i];
    for_each_coordinate(*order_[s], parts_[s], [&](const Part& part, const lanes::Part& flat) {
      if (part.kind == PartKind::group) {
        to.groups[part.group].X = pose_at(state + flat.value);
        return;
      }
      const int count = part.kind == PartKind::spring ? 6 : 1;
      for (int i = 0; i < count; ++i) to.x[part.column + i] = state[flat.value + i];
    });
  }
  configuration.X_MP = pose_at(state + program_.platform);
  return configuration;
}

}  // namespace counterflex
