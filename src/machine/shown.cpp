#include "counterflex/machine/shown.hpp"

#include <algorithm>

namespace counterflex {
namespace {

bool is_shown_as_it_is(const Actuator& actuator) {
  const ShownValue& shown = actuator.shown;
  return shown.sign == 1 && shown.zero == 0 && shown.coupled.empty();
}

}  // namespace

ShownActuators shown_actuators(const Machine& machine) {
  const std::vector<Actuator> all = actuators(machine);
  if (std::all_of(all.begin(), all.end(), is_shown_as_it_is)) return {};
  const auto count = static_cast<Eigen::Index>(all.size());
  ShownActuators shown{Eigen::MatrixXd::Identity(count, count), Eigen::VectorXd::Zero(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const ShownValue& value = all[static_cast<std::size_t>(i)].shown;
    shown.A(i, i) = value.sign;
    shown.b[i] = value.zero;
    for (const auto& [actuator, factor] : value.coupled) {
      const auto other = static_cast<Eigen::Index>(actuator);
      shown.A.row(i) += factor * shown.A.row(other);
      shown.b[i] += factor * shown.b[other];
    }
  }
  return shown;
}

double shown_value(const ShownActuators& shown, Eigen::Index actuator, const double* q) {
  if (!shown.differ()) return q[actuator];
  double value = shown.b[actuator];
  for (Eigen::Index i = 0; i <= actuator; ++i) value += shown.A(actuator, i) * q[i];
  return value;
}

Eigen::VectorXd shown_values(const ShownActuators& shown, const Eigen::VectorXd& q) {
  Eigen::VectorXd values(q.size());
  for (Eigen::Index i = 0; i < q.size(); ++i) values[i] = shown_value(shown, i, q.data());
  return values;
}

Eigen::VectorXd joint_values(const ShownActuators& shown, const Eigen::VectorXd& s) {
  if (!shown.differ()) return s;
  return shown.A.triangularView<Eigen::Lower>().solve(s - shown.b);  // couplings are with earlier actuators
}

Eigen::VectorXd home_values(const Machine& machine) {
  const std::vector<Actuator> all = actuators(machine);
  Eigen::VectorXd homes(static_cast<Eigen::Index>(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) homes[static_cast<Eigen::Index>(i)] = all[i].home;
  return homes;
}

Eigen::VectorXd shown_homes(const Machine& machine) {
  return shown_values(shown_actuators(machine), home_values(machine));
}

}  // namespace counterflex
