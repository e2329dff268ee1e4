#include <algorithm>
#include <vector>

#include "counterflex/machine/parameter_places.hpp"
#include "counterflex/machine/parameters.hpp"

namespace counterflex {

std::optional<double> stated_deviation(const Machine& machine, const Parameter& parameter) {
  const auto stated = std::find_if(machine.parameters.begin(), machine.parameters.end(),
                                   [&](const ParameterStatement& s) { return s.name == parameter.name; });
  if (stated != machine.parameters.end() && stated->sigma) return stated->sigma;
  if (parameter.kind != ParameterKind::table) return std::nullopt;
  Machine copy = machine;
  for (const ParameterPlace& place : parameter_places(copy))
    if (place.name == parameter.name) return std::get<Actuator>(*place.element).errors->sigma;
  return std::nullopt;
}

KnownParameters uncertain_parameters(const Machine& machine) {
  KnownParameters known;
  if (machine.uncertainty && machine.uncertainty->known) known = *machine.uncertainty->known;
  const auto fitted = static_cast<Eigen::Index>(known.names.size());
  std::vector<double> variances;
  for (const Parameter& parameter : parameters(machine)) {
    const bool is_known =
        std::find(known.names.begin(), known.names.end(), parameter.name) != known.names.end();
    const double sigma = stated_deviation(machine, parameter).value_or(0);
    if (is_known || parameter.kind == ParameterKind::reversal || sigma == 0) continue;
    known.names.push_back(parameter.name);
    variances.push_back(sigma * sigma);
  }
  const auto all = static_cast<Eigen::Index>(known.names.size());
  if (variances.empty()) return known;
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(all, all);
  if (fitted > 0) C.topLeftCorner(fitted, fitted) = known.covariance;
  C.diagonal().tail(all - fitted) = Eigen::Map<const Eigen::VectorXd>(variances.data(), all - fitted);
  known.covariance = std::move(C);
  return known;
}

}  // namespace counterflex
