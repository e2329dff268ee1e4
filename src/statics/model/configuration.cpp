#include "counterflex/statics/mechanism.hpp"

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

// Calls visit(part, value of its column) for every actuator in a series and in its groups.
template <class State, class Visit>
void for_each_actuator(const Series& series, State& state, const Visit& visit) {
  for (const Part& part : series.parts) {
    if (part.kind == PartKind::actuator) visit(part, state.x[part.column]);
    if (part.kind != PartKind::group) continue;
    for (std::size_t b = 0; b < series.groups[part.group].branches.size(); ++b)
      for_each_actuator(series.groups[part.group].branches[b], state.groups[part.group].branches[b], visit);
  }
}

}  // namespace

Configuration zero_configuration(const Mechanism& mechanism) {
  Configuration configuration;
  for (const Series& chain : mechanism.chains) configuration.chains.push_back(zero_state(chain));
  return configuration;
}

Eigen::VectorXd actuator_values(const Mechanism& mechanism, const Configuration& configuration) {
  Eigen::VectorXd rho(mechanism.travel.size());
  for (std::size_t i = 0; i < mechanism.chains.size(); ++i)
    for_each_actuator(mechanism.chains[i], configuration.chains[i],
                      [&](const Part& part, const double& value) { rho[part.actuator] = value; });
  return rho;
}

void set_actuator_values(const Mechanism& mechanism, const Eigen::VectorXd& rho,
                         Configuration& configuration) {
  for (std::size_t i = 0; i < mechanism.chains.size(); ++i)
    for_each_actuator(mechanism.chains[i], configuration.chains[i],
                      [&](const Part& part, double& value) { value = rho[part.actuator]; });
}

}  // namespace counterflex
