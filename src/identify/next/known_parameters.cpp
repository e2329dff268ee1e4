#include <algorithm>

#include "counterflex/identify/identify.hpp"
#include "identify/prior.hpp"

namespace counterflex {

KnownParameters known_parameters(const Identification& found) {
  KnownParameters known;
  for (const IdentifiedParameter& parameter : found.parameters) known.names.push_back(parameter.name);
  const auto fitted = static_cast<Eigen::Index>(known.names.size());
  std::vector<double> variances;
  for (const Parameter& parameter : parameters(found.machine)) {
    const bool is_fitted = std::find(known.names.begin(), known.names.begin() + fitted, parameter.name) !=
                           known.names.begin() + fitted;
    const auto [sigma, is_default] = prior_deviation(found.machine, parameter);
    // A place for harmonics does not mean that there are any.
    const bool is_place = parameter.kind == ParameterKind::harmonic && is_default;
    if (is_fitted || parameter.kind == ParameterKind::reversal || is_place || sigma == 0) continue;
    known.names.push_back(parameter.name);
    variances.push_back(sigma * sigma);
  }
  const auto all = static_cast<Eigen::Index>(known.names.size());
  known.covariance = Eigen::MatrixXd::Zero(all, all);
  known.covariance.topLeftCorner(fitted, fitted) = found.covariance;
  known.covariance.diagonal().tail(all - fitted) =
      Eigen::Map<const Eigen::VectorXd>(variances.data(), all - fitted);
  return known;
}

}  // namespace counterflex
