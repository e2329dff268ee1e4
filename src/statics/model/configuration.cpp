#include "counterflex/statics/mechanism.hpp"
#include "statics/model/walk.hpp"

namespace counterflex {
namespace {

SeriesState zero_state(const Series& series) {
  SeriesState state;
  state.x = Eigen::VectorXd::Zero(series.columns);
  state.x_nominal = state.x;
  for (const SeriesGroup& group : series.groups) {
    GroupState inner;
    for (const Series& branch : group.branches) inner.branches.push_back(zero_state(branch));
    state.groups.push_back(std::move(inner));
  }
  return state;
}

// Calls visit(actuator, value) for every actuator.
template <class Configuration, class Visit>
void for_each_actuator(const Mechanism& mechanism, Configuration& configuration, const Visit& visit) {
  for_each_series(mechanism.chains, configuration.chains, [&](const Series& series, auto& state) {
    for (const Part& part : series.parts)
      if (part.kind == PartKind::actuator) visit(part.actuator, state.x[part.column]);
  });
}

}  // namespace

Configuration zero_configuration(const Mechanism& mechanism) {
  Configuration configuration;
  for (const Series& chain : mechanism.chains) configuration.chains.push_back(zero_state(chain));
  return configuration;
}

Eigen::VectorXd actuator_values(const Mechanism& mechanism, const Configuration& configuration) {
  Eigen::VectorXd rho(mechanism.travel.size());
  for_each_actuator(mechanism, configuration, [&](int actuator, double value) { rho[actuator] = value; });
  return rho;
}

void set_actuator_values(const Mechanism& mechanism, const Eigen::VectorXd& rho,
                         Configuration& configuration) {
  for_each_actuator(mechanism, configuration, [&](int actuator, double& value) { value = rho[actuator]; });
}

}  // namespace counterflex
