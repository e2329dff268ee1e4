#include "counterflex/statics/mechanism.hpp"

#include <algorithm>

#include "statics/model/home.hpp"
#include "statics/model/motion_errors.hpp"
#include "statics/model/part.hpp"
#include "statics/model/walk.hpp"

namespace counterflex {
namespace {

constexpr double spacing_of_harmonic = pi / 6;  // a twelfth of its period, as if these were knots

struct Numbering {
  int next_actuator = 0;
  std::vector<Travel>& travel;
};

/// `turns`: whether the frame where the series starts may turn.
Series compile_series(const Branch& branch, bool weighs, bool turns, Numbering& numbering);

// Adds one element to a series: `add(element)` for every kind of element.
struct Compiler {
  Series& series;
  bool weighs, turns;
  Numbering& numbering;

  void columns(Part& part, const std::vector<bool>& angular) {
    part.column = series.columns;
    for (bool a : angular) {
      (part.kind == PartKind::actuator ? series.commanded : series.free).push_back(series.columns++);
      series.angular.push_back(a);
      series.screws.push_back(!part.errors.empty());
      turns = turns || a || !part.errors.empty();
    }
  }
  void joint_column(Part& part) { columns(part, {part.joint.kind == JointKind::revolute}); }
  void pose_columns(Part& part) { columns(part, {false, false, false, true, true, true}); }

  Part operator()(const Rigid& e) const { return {.kind = PartKind::fixed, .X = e.X}; }
  Part operator()(const AssemblyError& e) const {
    return {.kind = PartKind::error, .X = e.X, .log_R = log_so3(e.X.R)};
  }
  Part operator()(const Actuator& e) {
    if (e.program_axis > 0) return {.kind = PartKind::fixed, .X = displacement(e.joint, e.home)};
    Part part{
        .kind = PartKind::actuator, .joint = e.joint, .home = e.home, .actuator = numbering.next_actuator++};
    part.errors = motion_errors(e);
    numbering.travel.push_back({e.min, e.max, e.joint.kind});
    series.actuators.push_back(part.actuator);
    joint_column(part);
    return part;
  }
  Part operator()(const Passive& e) {
    Part part{.kind = PartKind::passive,
              .joint = e.joint,
              .k = e.stiffness,
              .rest = e.rest,
              .rest_at_home = e.rest_at_home,
              .home = e.home};
    joint_column(part);
    return part;
  }
  Part operator()(const Compliance& e) {
    Part part{.kind = PartKind::compliance, .joint = e.joint, .k = e.stiffness};
    if (e.beyond) {
      part.k_change = e.beyond->stiffness - e.stiffness;
      part.knee = e.beyond->knee / e.stiffness;
    }
    joint_column(part);
    return part;
  }
  Part operator()(const Spring& e) {
    Part part{.kind = PartKind::spring, .K = e.K, .theta_0 = e.theta_0};
    pose_columns(part);
    return part;
  }
  Part operator()(const Group& e) {
    Part part{.kind = PartKind::group, .group = static_cast<int>(series.groups.size())};
    SeriesGroup group;
    for (const Branch& branch : e.branches) {
      group.branches.push_back(compile_series(branch, weighs, turns, numbering));
      const auto& inner = group.branches.back().actuators;
      series.mass += group.branches.back().mass;
      series.actuators.insert(series.actuators.end(), inner.begin(), inner.end());
    }
    series.groups.push_back(std::move(group));
    pose_columns(part);
    return part;
  }
  Part operator()(const PointMass& e) const {
    series.mass += e.kg;
    ++series.masses;
    return {.kind = PartKind::mass, .X = translation(e.at), .mass = e.kg};
  }
};

Series compile_series(const Branch& branch, bool weighs, bool turns, Numbering& numbering) {
  Series series;
  series.name = branch.name;
  Compiler compiler{series, weighs, turns, numbering};
  for (const Element& element : branch.elements)
    if (weighs || !std::holds_alternative<PointMass>(element))
      series.parts.push_back(std::visit(compiler, element));
  series.leans = turns && series.mass > 0;
  return series;
}

std::vector<double> reversals(const Machine& machine) {
  std::vector<double> all;
  bool any = false;
  for (const Actuator& actuator : actuators(machine)) {
    all.push_back(actuator.reversal.value_or(0));
    any = any || all.back() > 0;
  }
  return any ? all : std::vector<double>{};
}

void note_bends(const Series& series, Mechanism& mechanism) {
  for (const Part& part : series.parts) {
    mechanism.has_knees = mechanism.has_knees || part.k_change != 0;
    if (!part.errors.rho.empty()) mechanism.error_knots.push_back({part.actuator, part.errors.rho});
    double& least =
        part.joint.kind == JointKind::prismatic ? mechanism.error_spacing : mechanism.error_spacing_angle;
    for (std::size_t k = 1; k < part.errors.rho.size(); ++k)
      least = std::min(least, part.errors.rho[k] - part.errors.rho[k - 1]);
    if (const std::size_t orders = part.errors.harmonics.size() / 2; orders > 0)
      least = std::min(least, spacing_of_harmonic / static_cast<double>(orders));
  }
}

}  // namespace

Mechanism compile(const Machine& machine) {
  Mechanism mechanism;
  mechanism.name = machine.name;
  mechanism.controlled = machine.controlled;
  std::sort(mechanism.controlled.begin(), mechanism.controlled.end());
  mechanism.X_PT = machine.X_PT;
  mechanism.p_EP = machine.p_EP;
  mechanism.shown = shown_actuators(machine);
  mechanism.reversal = reversals(machine);
  mechanism.gravity = machine.gravity.g;
  mechanism.fixture = machine.fixture;
  const bool weighs = !mechanism.gravity.isZero(0);
  mechanism.ends_with_tool_mass = weighs && machine.ends_with_tool_mass;
  Numbering numbering{0, mechanism.travel};
  for (const Chain& chain : machine.chains)
    mechanism.chains.push_back(compile_series(chain, weighs, false, numbering));
  for_each_series(mechanism.chains, [&](const Series& series) { note_bends(series, mechanism); });
  const std::vector<std::string> names = actuator_names(machine);
  for (std::size_t i = 0; i < names.size(); ++i) mechanism.travel[i].name = names[i];
  return mechanism;
}

bool has_preload(const Mechanism& mechanism) {
  const auto is_preloaded = [](const Part& part) {
    return (part.kind == PartKind::spring && !part.theta_0.isZero(0)) ||
           (part.kind == PartKind::passive && part.k != 0);
  };
  bool any = false;
  for_each_series(mechanism.chains, [&](const Series& series) {
    any = any || std::ranges::any_of(series.parts, is_preloaded);
  });
  return any;
}

bool controls(const Mechanism& mechanism, Component component) {
  return std::ranges::count(mechanism.controlled, component) > 0;
}

bool only_slides(const Mechanism& mechanism) {
  const auto slides = [](const Part& part) {
    const bool turns = part.kind == PartKind::actuator && part.joint.kind == JointKind::revolute;
    return !turns && part.kind != PartKind::passive && part.kind != PartKind::group;
  };
  return mechanism.chains.size() == 1 && std::ranges::all_of(mechanism.chains.front().parts, slides);
}

bool has_weight(const Mechanism& mechanism) {
  if (mechanism.gravity.isZero(0)) return false;
  return !zero_offsets(mechanism).isZero(0) ||
         std::any_of(mechanism.chains.begin(), mechanism.chains.end(),
                     [](const Series& chain) { return chain.mass > 0; });
}

}  // namespace counterflex
