#include "statics/model/home.hpp"

#include <algorithm>

#include "counterflex/statics/equilibrium.hpp"
#include "statics/model/part.hpp"
#include "statics/model/walk.hpp"
#include "statics/solve/kinematics.hpp"

namespace counterflex {
namespace {

// Calls visit(part) for every actuator.
template <class Chains, class Visit>
void for_each_actuator_part(Chains& chains, const Visit& visit) {
  for_each_series(chains, [&](auto& series) {
    for (auto& part : series.parts)
      if (part.kind == PartKind::actuator) visit(part);
  });
}

// Joints at their home values, groups where their first branch ends. Returns where the series ends.
Pose start_at_joint_homes(const Series& series, SeriesState& state) {
  Pose X;
  for (const Part& part : series.parts) {
    if (part.kind == PartKind::actuator || part.kind == PartKind::passive) state.x[part.column] = part.home;
    if (part.kind == PartKind::group) {
      GroupState& group = state.groups[part.group];
      for (std::size_t b = group.branches.size(); b-- > 0;)
        group.X = start_at_joint_homes(series.groups[part.group].branches[b], group.branches[b]);
    }
    X = X * part_pose(part, state, nominal_stage);
  }
  return X;
}

void find_home(const Machine& machine, Model& model) {
  Mechanism& mechanism = model.mechanism;
  model.home = zero_configuration(mechanism);
  for (std::size_t i = mechanism.chains.size(); i-- > 0;)
    model.home.X_MP = start_at_joint_homes(mechanism.chains[i], model.home.chains[i]);
  if (machine.home_X_MP) model.home.X_MP = *machine.home_X_MP;
  const Moving moving = machine.home_X_MP ? Moving{true, false} : Moving{false, true};
  model.home_gap = Kinematics(mechanism, moving).solve(nullptr, model.home);
  model.home_status = model.home_gap < home_tolerance ? Status::converged : Status::unreachable;
}

// Mean distance of joint and spring frames from the reference point.
struct FrameDistances {
  double sum = 0;
  int count = 0;

  void add(const Series& series, const SeriesState& state, const Pose& start, const Vector3& reference) {
    Pose X = start;
    for (const Part& part : series.parts) {
      if (part.column >= 0 && part.kind != PartKind::group) {
        sum += (X.p - reference).norm();
        ++count;
      }
      if (part.kind == PartKind::group)
        for (std::size_t b = 0; b < state.groups[part.group].branches.size(); ++b)
          add(series.groups[part.group].branches[b], state.groups[part.group].branches[b], X, reference);
      X = X * part_pose(part, state, nominal_stage);
    }
  }
};

// The largest stiffness of a joint or spring (N/m).
double stiffest(const std::vector<Series>& chains, double length) {
  double largest = 0;
  for_each_series(chains, [&](const Series& series) {
    for (const Part& part : series.parts) {
      const bool angular = part.joint.kind == JointKind::revolute;
      if (part.kind == PartKind::passive || part.kind == PartKind::compliance)
        largest =
            std::max(largest, (part.k + std::max(part.k_change, 0.0)) / (angular ? length * length : 1));
      if (part.kind == PartKind::spring)
        largest = std::max({largest, part.K.topLeftCorner<3, 3>().cwiseAbs().maxCoeff(),
                            part.K.bottomRightCorner<3, 3>().cwiseAbs().maxCoeff() / (length * length)});
    }
  });
  return largest;
}

void relax_at_home(Model& model) {
  for_each_series(model.mechanism.chains, model.home.chains, [](Series& series, const SeriesState& home) {
    for (Part& part : series.parts)
      if (part.kind == PartKind::passive && part.rest_at_home) part.rest = home.x[part.column];
  });
}

// A controller whose zero was set at home, under the machine's own weight: finds the actuators' offsets with
// which the perfect, preloaded machine without a load has the controlled components of its tip at home's
// pose, or gives the reason in `gravity_status`. EQUATIONS.md, section 10.
void hold_home(Model& model) {
  StaticsWork work(model.mechanism);
  const Stage by_weight{.errors = 0, .load = 0};
  const Equilibrium held =
      solve_target(model, model.home, tip(model.mechanism, model.home), {}, by_weight, work);
  model.gravity_status = held.status;
  if (held.status != Status::converged) return;
  const Eigen::VectorXd offsets =
      actuator_values(model.mechanism, held.configuration) - actuator_values(model.mechanism, model.home);
  // Without weights and preloads home is the zero as it is; the noise of solving would set others.
  if (offsets.size() > 0 && offsets.cwiseAbs().maxCoeff() > closure_tolerance)
    set_zero_offsets(offsets, model.mechanism);
}

}  // namespace

void mark_nominal(Configuration& configuration) {
  for_each_series(configuration.chains, [](SeriesState& state) {
    state.x_nominal = state.x;
    state.F.setZero();
  });
}

Eigen::VectorXd zero_offsets(const Mechanism& mechanism) {
  Eigen::VectorXd offsets(static_cast<Eigen::Index>(mechanism.travel.size()));
  for_each_actuator_part(mechanism.chains, [&](const Part& part) { offsets[part.actuator] = part.offset; });
  return offsets;
}

void set_zero_offsets(const Eigen::VectorXd& offsets, Mechanism& mechanism) {
  for_each_actuator_part(mechanism.chains, [&](Part& part) { part.offset = offsets[part.actuator]; });
}

Model prepare(const Machine& machine) {
  Model model;
  model.mechanism = compile(machine);
  find_home(machine, model);
  settle_at_home(model);
  if (machine.gravity.true_at_home && model.home_status == Status::converged) hold_home(model);
  return model;
}

void settle_at_home(Model& model) {
  mark_nominal(model.home);
  relax_at_home(model);
  FrameDistances distances;
  for (std::size_t i = 0; i < model.mechanism.chains.size(); ++i)
    distances.add(model.mechanism.chains[i], model.home.chains[i], {}, model.home.X_MP.p);
  model.mechanism.length = std::max(0.1, distances.count ? distances.sum / distances.count : 0.0);
  model.mechanism.stiffest = stiffest(model.mechanism.chains, model.mechanism.length);
}

}  // namespace counterflex
