#include <algorithm>
#include <cmath>
#include <optional>

#include "counterflex/statics/chain.hpp"
#include "counterflex/statics/theory.hpp"
#include "statics/model/part.hpp"

namespace counterflex {
namespace {

constexpr Stage everything{};

// Calls visit(CoordinateDetail) for every coordinate of a joint, a compliance or a spring.
template <class Visit>
void visit_coordinates(const Part& part, const SeriesState& state, const Visit& visit) {
  if (part.kind == PartKind::spring) {
    const Vector6 theta = state.x.segment<6>(part.column),
                  tau = part.K * spring_deflection(part, state, everything);
    for (int k = 0; k < 6; ++k)
      visit(CoordinateDetail{.kind = part.kind,
                             .component = k,
                             .angular = k >= 3,
                             .value = theta[k],
                             .change = theta[k],
                             .load = tau[k]});
  } else if (part.column >= 0 && part.kind != PartKind::group) {
    const double x = state.x[part.column];
    visit(CoordinateDetail{
        .kind = part.kind,
        .angular = part.joint.kind == JointKind::revolute,
        .value = x,
        .change = x - state.x_nominal[part.column],
        .load = part.kind == PartKind::actuator ? 0 : force_of_joint(part, state, everything).force});
  }
}

double largest(const Vector3& v) {
  return v.cwiseAbs().maxCoeff();
}

void raise(double& maximum, double value) {
  maximum = std::max(maximum, std::abs(value));
}

// Orientation of the frame before the first spring, in the start frame of the series.
std::optional<Matrix3> first_spring_axes(const Series& series, const SeriesState& state) {
  Pose X;
  for (const Part& part : series.parts) {
    if (part.kind == PartKind::spring) return X.R;
    X = X * part_pose(part, state, everything);
  }
  return std::nullopt;
}

void add_coordinate(const CoordinateDetail& c, ChainLoads& loads) {
  if (c.kind == PartKind::passive && c.angular) raise(loads[LoadKind::passive_change], c.change);
  if (c.kind != PartKind::spring && c.kind != PartKind::compliance) return;
  raise(c.angular ? loads[LoadKind::spring_rotation] : loads[LoadKind::spring_translation], c.value);
  raise(c.angular ? loads[LoadKind::spring_torque] : loads[LoadKind::spring_force], c.load);
}

void add_group(const SeriesGroup& group, const GroupState& state, ChainLoads& loads) {
  Vector6 F = Vector6::Zero();
  for (const SeriesState& branch : state.branches) F += branch.F;
  const auto axes = first_spring_axes(group.branches[0], state.branches[0]);
  const Vector3 moment = F.tail<3>();
  raise(loads[LoadKind::group_moment], largest(axes ? Vector3(axes->transpose() * moment) : moment));
}

// The parts in the first `columns` columns.
void add_series(const Series& series, int columns, const SeriesState& state, ChainLoads& loads) {
  for (const Part& part : series.parts) {
    if (part.column >= columns) continue;
    visit_coordinates(part, state, [&](const CoordinateDetail& c) { add_coordinate(c, loads); });
    if (part.kind != PartKind::group) continue;
    add_group(series.groups[part.group], state.groups[part.group], loads);
    for (std::size_t b = 0; b < state.groups[part.group].branches.size(); ++b) {
      const Series& branch = series.groups[part.group].branches[b];
      add_series(branch, branch.columns, state.groups[part.group].branches[b], loads);
    }
  }
}

// Where the first `parts` parts of a series end, in its start frame.
Pose end_of(const Series& series, std::size_t parts, const SeriesState& state) {
  Pose X;
  for (std::size_t i = 0; i < parts; ++i) X = X * part_pose(series.parts[i], state, everything);
  return X;
}

// The weight of the tool, which hangs on the platform: its mass is the last one of the first chain. At `p` of
// the start frame, in its axes.
Vector6 tool_weight(const Series& series, const Vector3& p, const SeriesState& state,
                    const Vector3& gravity) {
  std::size_t i = series.parts.size() - 1;
  while (series.parts[i].kind != PartKind::mass) --i;
  Vector6 weight = Vector6::Zero();
  weight.head<3>() = series.parts[i].mass * gravity;
  return wrench_at(weight, end_of(series, i, state) * series.parts[i].X.p - p);
}

// Of `series` as far as it is `base`: a tool's parts follow those of its chain. `gravity`: that acts on the
// mass of the tool, if the chain has it.
ChainLoads chain_loads(const Series& base, const Series& series, const SeriesState& state,
                       const std::optional<Vector3>& gravity) {
  ChainLoads chain;
  chain.name = series.name;
  const Vector3 p = end_of(series, base.parts.size(), state).p;
  chain.wrench = wrench_at(state.F, end_of(series, series.parts.size(), state).p - p);
  if (gravity) chain.wrench += tool_weight(series, p, state, *gravity);
  chain[LoadKind::moment] = largest(chain.wrench.tail<3>());
  add_series(series, base.columns, state, chain);
  return chain;
}

// Fills the coordinates of a chain.
struct Collector {
  ChainDetail& detail;

  void series(const Series& series, const SeriesState& state, const std::string& path) {
    int number = 0;
    for (const Part& part : series.parts) {
      if (part.kind == PartKind::mass) continue;
      const std::string element = path + std::to_string(++number);
      if (part.kind == PartKind::group) group(series, part, state, element);
      if (part.column < 0 || part.kind == PartKind::group) continue;
      if (path.empty()) list_row(part);
      visit_coordinates(part, state, [&](CoordinateDetail c) {
        c.element = element;
        detail.coordinates.push_back(std::move(c));
      });
    }
  }

  void group(const Series& series, const Part& part, const SeriesState& state, const std::string& element) {
    const auto& branches = series.groups[part.group].branches;
    for (std::size_t b = 0; b < branches.size(); ++b)
      this->series(branches[b], state.groups[part.group].branches[b], element + "/" + branches[b].name + "/");
  }

  // Rows of K_Cq and K_Ctheta are of the chain's own columns.
  void list_row(const Part& part) {
    const std::size_t next = detail.coordinates.size();
    if (part.kind == PartKind::passive) detail.passive.push_back(next);
    if (part.kind == PartKind::compliance) detail.elastic.push_back(next);
    for (std::size_t k = 0; part.kind == PartKind::spring && k < 6; ++k) detail.elastic.push_back(next + k);
  }
};

}  // namespace

std::vector<ChainLoads> loads(const Mechanism& base, const Model& model, const Configuration& configuration) {
  const Mechanism& mechanism = model.mechanism;
  const bool as_branches = base.chains.size() != mechanism.chains.size();
  const auto& chains = as_branches ? mechanism.chains.front().groups.front().branches : mechanism.chains;
  const auto& states =
      as_branches ? configuration.chains.front().groups.front().branches : configuration.chains;
  std::vector<ChainLoads> all;
  for (std::size_t i = 0; i < chains.size(); ++i) {
    const bool carries_tool = i == 0 && mechanism.ends_with_tool_mass;
    all.push_back(chain_loads(base.chains[i], chains[i], states[i],
                              carries_tool ? std::optional(mechanism.gravity) : std::nullopt));
  }
  return all;
}

std::vector<ChainDetail> chain_details(const Model& model, const Configuration& nominal,
                                       const Configuration& loaded, const Vector6& dt_P,
                                       const StiffnessPlace& stiff, StaticsWork& work) {
  const auto eps = chain_eps(model, nominal, work);
  std::vector<ChainDetail> all;
  for (std::size_t i = 0; i < model.mechanism.chains.size(); ++i) {
    const Series& series = model.mechanism.chains[i];
    ChainDetail detail{.name = series.name, .wrench = loaded.chains[i].F, .eps = eps[i]};
    detail.stiffness = chain_stiffness(model, i, stiff.configuration.chains[i], stiff.stage, work);
    if (eps[i]) detail.dt = dt_P - *eps[i];
    detail.energy = elastic_energy(series, loaded.chains[i], everything);
    Collector{detail}.series(series, loaded.chains[i], "");
    all.push_back(std::move(detail));
  }
  return all;
}

}  // namespace counterflex
