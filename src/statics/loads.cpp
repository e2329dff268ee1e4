#include "counterflex/statics/loads.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "part_pose.hpp"

namespace counterflex {
namespace {

double largest(const Vector3& v) { return v.cwiseAbs().maxCoeff(); }

void raise(double& maximum, double value) { maximum = std::max(maximum, std::abs(value)); }

// Orientation of the frame before the first spring, in the start frame of the series.
std::optional<Matrix3> first_spring_axes(const Series& series, const SeriesState& state, const Stage& stage) {
  Pose X;
  for (const Part& part : series.parts) {
    if (part.kind == PartKind::spring) return X.R;
    X = X * part_pose(part, state, stage);
  }
  return std::nullopt;
}

void add_spring(const Part& part, const SeriesState& state, const Stage& stage, ChainLoads& loads) {
  const Vector6 theta = state.x.segment<6>(part.column);
  const Vector6 tau = part.K * (theta - stage.preload * part.theta_0);
  raise(loads.spring_translation_max, largest(theta.head<3>()));
  raise(loads.spring_rotation_max, largest(theta.tail<3>()));
  raise(loads.spring_force_max, largest(tau.head<3>()));
  raise(loads.spring_torque_max, largest(tau.tail<3>()));
}

void add_compliance(const Part& part, const SeriesState& state, ChainLoads& loads) {
  const double theta = state.x[part.column];
  const bool turns = part.joint.kind == JointKind::revolute;
  raise(turns ? loads.spring_rotation_max : loads.spring_translation_max, theta);
  raise(turns ? loads.spring_torque_max : loads.spring_force_max, part.k * theta);
}

void add_group(const SeriesGroup& group, const GroupState& state, const Stage& stage, ChainLoads& loads) {
  Vector6 F = Vector6::Zero();
  for (const SeriesState& branch : state.branches) F += branch.F;
  const auto axes = first_spring_axes(group.branches[0], state.branches[0], stage);
  const Vector3 moment = F.tail<3>();
  raise(loads.group_moment_max, largest(axes ? Vector3(axes->transpose() * moment) : moment));
}

void add_series(const Series& series, const SeriesState& state, const Stage& stage, ChainLoads& loads) {
  for (const Part& part : series.parts) {
    if (part.kind == PartKind::spring) add_spring(part, state, stage, loads);
    if (part.kind == PartKind::compliance) add_compliance(part, state, loads);
    if (part.kind == PartKind::passive && part.joint.kind == JointKind::revolute)
      raise(loads.passive_change_max, state.x[part.column] - state.x_nominal[part.column]);
    if (part.kind != PartKind::group) continue;
    add_group(series.groups[part.group], state.groups[part.group], stage, loads);
    for (std::size_t b = 0; b < state.groups[part.group].branches.size(); ++b)
      add_series(series.groups[part.group].branches[b], state.groups[part.group].branches[b], stage, loads);
  }
}

}  // namespace

std::vector<ChainLoads> loads(const Model& model, const Configuration& configuration, const Stage& stage) {
  std::vector<ChainLoads> all;
  for (std::size_t i = 0; i < configuration.chains.size(); ++i) {
    ChainLoads chain;
    chain.name = model.mechanism.chains[i].name;
    chain.wrench = configuration.chains[i].F;
    chain.moment_max = largest(chain.wrench.tail<3>());
    add_series(model.mechanism.chains[i], configuration.chains[i], stage, chain);
    all.push_back(std::move(chain));
  }
  return all;
}

}  // namespace counterflex
