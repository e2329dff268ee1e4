#include <algorithm>
#include <cmath>
#include <optional>

#include "counterflex/statics/chain.hpp"
#include "statics/model/part.hpp"

namespace counterflex {
namespace {

double largest(const Vector3& v) {
  return v.cwiseAbs().maxCoeff();
}

void raise(double& maximum, double value) {
  maximum = std::max(maximum, std::abs(value));
}

// Orientation of the frame before the first spring, in the start frame of the series.
std::optional<Matrix3> first_spring_axes(const Series& series, const SeriesState& state, const Stage& stage) {
  Pose X;
  for (const Part& part : series.parts) {
    if (part.kind == PartKind::spring) return X.R;
    X = X * part_pose(part, state, stage);
  }
  return std::nullopt;
}

void add_coordinate(PartKind kind, const PartCoordinate& c, ChainLoads& loads) {
  if (kind == PartKind::passive && c.angular) raise(loads.passive_change_max, c.change);
  if (kind != PartKind::spring && kind != PartKind::compliance) return;
  raise(c.angular ? loads.spring_rotation_max : loads.spring_translation_max, c.value);
  raise(c.angular ? loads.spring_torque_max : loads.spring_force_max, c.load);
}

void add_group(const SeriesGroup& group, const GroupState& state, const Stage& stage, ChainLoads& loads) {
  Vector6 F = Vector6::Zero();
  for (const SeriesState& branch : state.branches) F += branch.F;
  const auto axes = first_spring_axes(group.branches[0], state.branches[0], stage);
  const Vector3 moment = F.tail<3>();
  raise(loads.group_moment_max, largest(axes ? Vector3(axes->transpose() * moment) : moment));
}

// The parts in the first `columns` columns.
void add_series(const Series& series, int columns, const SeriesState& state, const Stage& stage,
                ChainLoads& loads) {
  for (const Part& part : series.parts) {
    if (part.column >= columns) continue;
    visit_coordinates(part, state, stage,
                      [&](const PartCoordinate& c) { add_coordinate(part.kind, c, loads); });
    if (part.kind != PartKind::group) continue;
    add_group(series.groups[part.group], state.groups[part.group], stage, loads);
    for (std::size_t b = 0; b < state.groups[part.group].branches.size(); ++b) {
      const Series& branch = series.groups[part.group].branches[b];
      add_series(branch, branch.columns, state.groups[part.group].branches[b], stage, loads);
    }
  }
}

// `arm`: from the chain's end to the reference point, axes of M.
ChainLoads chain_loads(const Series& series, int columns, const SeriesState& state, const Vector3& arm,
                       const Stage& stage) {
  ChainLoads chain;
  chain.name = series.name;
  chain.wrench = state.F;
  chain.wrench.tail<3>() -= arm.cross(Vector3(state.F.head<3>()));
  chain.moment_max = largest(chain.wrench.tail<3>());
  add_series(series, columns, state, stage, chain);
  return chain;
}

// Of `chains`, as far as they are those of `base`.
std::vector<ChainLoads> chains_loads(const std::vector<Series>& chains, const std::vector<Series>& base,
                                     const std::vector<SeriesState>& states, const Vector3& arm,
                                     const Stage& stage) {
  std::vector<ChainLoads> all;
  for (std::size_t i = 0; i < states.size(); ++i)
    all.push_back(chain_loads(chains[i], base[i].columns, states[i], arm, stage));
  return all;
}

Vector3 arm_of(const Model& model, const Configuration& configuration) {
  return configuration.X_MP.R * model.mechanism.p_EP;
}

// From the end of a series to where its first `parts` parts end, axes of its start frame.
Vector3 arm_to_part(const Series& series, std::size_t parts, const SeriesState& state, const Stage& stage) {
  Pose X;
  Vector3 p = Vector3::Zero();
  for (std::size_t i = 0; i <= series.parts.size(); ++i) {
    if (i == parts) p = X.p;
    if (i < series.parts.size()) X = X * part_pose(series.parts[i], state, stage);
  }
  return p - X.p;
}

}  // namespace

std::vector<ChainLoads> loads(const Model& model, const Configuration& configuration, const Stage& stage) {
  return chains_loads(model.mechanism.chains, model.mechanism.chains, configuration.chains,
                      arm_of(model, configuration), stage);
}

std::vector<ChainLoads> loads_without_tool(const Mechanism& base, const Model& model,
                                           const Configuration& configuration, const Stage& stage) {
  const std::vector<Series>& chains = model.mechanism.chains;
  if (base.chains.size() == chains.size()) {  // a tool's parts follow those of its chain
    std::vector<ChainLoads> all;
    for (std::size_t i = 0; i < chains.size(); ++i)
      all.push_back(chain_loads(
          chains[i], base.chains[i].columns, configuration.chains[i],
          arm_to_part(chains[i], base.chains[i].parts.size(), configuration.chains[i], stage), stage));
    return all;
  }
  const std::vector<Series>& branches = chains.front().groups.front().branches;
  return chains_loads(branches, branches, configuration.chains.front().groups.front().branches,
                      Vector3::Zero(), stage);
}

double value_of(const ChainLoads& loads, LoadKind kind) {
  switch (kind) {
    case LoadKind::moment:
      return loads.moment_max;
    case LoadKind::spring_translation:
      return loads.spring_translation_max;
    case LoadKind::spring_rotation:
      return loads.spring_rotation_max;
    case LoadKind::spring_force:
      return loads.spring_force_max;
    case LoadKind::spring_torque:
      return loads.spring_torque_max;
    case LoadKind::group_moment:
      return loads.group_moment_max;
    case LoadKind::passive_change:
      return loads.passive_change_max;
  }
  return 0;
}

}  // namespace counterflex
