#pragma once
/// Synthetic measurements of machines whose parameters are known.
#include <algorithm>
#include <cstddef>
#include <random>
#include <vector>

#include "counterflex/geometry/types.hpp"
#include "counterflex/identify/identify.hpp"
#include "counterflex/machine/parameters.hpp"
#include "counterflex/machine/shown.hpp"
#include "counterflex/statics/equilibrium.hpp"

namespace counterflex::campaigns {

using Random = std::mt19937_64;

inline double normal(Random& random) {
  return std::normal_distribution<double>()(random);
}
inline double uniform(Random& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}

inline std::vector<double> values_of(const Machine& machine) {
  std::vector<double> values;
  for (const Parameter& parameter : parameters(machine)) values.push_back(parameter.value);
  return values;
}

/// Tips of the machine with these actuator values (shown) and wrenches.
class Tips {
 public:
  explicit Tips(const Machine& machine) : model_(prepare(machine)), work_(model_.mechanism) {}

  Pose operator()(const CommandedState& state) {
    const NominalResult nominal =
        nominal_forward(model_, model_.home, joint_values(model_.mechanism.shown, state.shown));
    const Equilibrium found = solve_forward(model_, nominal.configuration, {state.F, false}, Stage{}, work_);
    return tip(model_.mechanism, found.configuration);
  }

 private:
  Model model_;
  StaticsWork work_;
};

/// States around home: each actuator within `share` of its travel, or `turn` of a rotary one.
inline CommandedState random_state(const Machine& machine, double length, double turn, Random& random) {
  const std::vector<Actuator> all = actuators(machine);
  CommandedState state{shown_homes(machine)};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double reach = all[i].joint.kind == JointKind::revolute ? turn : length;
    state.shown[static_cast<Eigen::Index>(i)] += uniform(random, -reach, reach);
  }
  return state;
}

/// Tracker rows of the true machine, its frame at `X_SM`, the probe at `X_TB`.
inline void add_tracker(const Machine& truth, const Pose& X_SM, const Pose& X_TB, bool has_orientation,
                        std::size_t count, double length, double turn, double sigma, Random& random,
                        Measurements& all, const std::string& name) {
  Tips tips(truth);
  all.sessions.push_back(
      {name, has_orientation ? MeasurementKind::tracker_pose : MeasurementKind::tracker_point, true, Pose{}});
  for (std::size_t i = 0; i < count; ++i) {
    Measurement row;
    row.session = all.sessions.size() - 1;
    row.at = {name + ".csv", static_cast<int>(i) + 2, 1};
    row.states.push_back(random_state(truth, length, turn, random));
    row.sigma = std::max(sigma, 1e-7);
    row.sigma_angle = std::max(sigma * 4, 4e-7);
    row.X = X_SM * tips(row.states[0]) * X_TB;
    for (int k = 0; k < 3; ++k) row.X.p[k] += sigma * normal(random);
    if (has_orientation)
      row.X.R = exp_so3(sigma * 4 * Vector3(normal(random), normal(random), normal(random))) * row.X.R;
    all.rows.push_back(row);
  }
}

/// Pushes with up to `force` in random directions, read along the force.
inline void add_pushes(const Machine& truth, std::size_t count, double length, double turn, double force,
                       double sigma, Random& random, Measurements& all) {
  Tips tips(truth);
  all.sessions.push_back({"pushes", MeasurementKind::static_push, true, Pose{}});
  for (std::size_t i = 0; i < count; ++i) {
    Measurement row;
    row.session = all.sessions.size() - 1;
    row.at = {"pushes.csv", static_cast<int>(i) + 2, 1};
    row.states.push_back(random_state(truth, length, turn, random));
    row.states.push_back(row.states[0]);
    row.direction = Vector3(normal(random), normal(random), normal(random)).normalized();
    row.states[0].F.head<3>() = force * row.direction;
    row.sigma = std::max(sigma, 1e-8);
    row.value = row.direction.dot(tips(row.states[0]).p - tips(row.states[1]).p) + sigma * normal(random);
    all.rows.push_back(row);
  }
}

}  // namespace counterflex::campaigns
