#include "identify/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/parameter_places.hpp"
#include "identify/prior.hpp"

namespace counterflex {
namespace {

constexpr double least_share = 1e-3;  // of a compliance or mass: the lower bound of the fit

double least_value(const Parameter& parameter) {
  switch (parameter.kind) {
    case ParameterKind::compliance:
    case ParameterKind::mass:
      return least_share * parameter.value;
    case ParameterKind::reversal:
      return 0;
    default:
      return -std::numeric_limits<double>::infinity();
  }
}

/// By parameter: whether it moves the zero of the actuator just before its error slot.
std::vector<bool> zeros_of(const Machine& machine) {
  Machine copy = machine;
  std::map<const Element*, const Actuator*> before;
  const auto visit = [&](const auto& self, const std::vector<Element>& elements) -> void {
    const Actuator* last = nullptr;
    for (const Element& element : elements) {
      if (std::holds_alternative<AssemblyError>(element)) before[&element] = last;
      if (const auto* actuator = std::get_if<Actuator>(&element))
        last = actuator;
      else if (!std::holds_alternative<Compliance>(element) && !std::holds_alternative<PointMass>(element))
        last = nullptr;
      if (const auto* group = std::get_if<Group>(&element))
        for (const Branch& branch : group->branches) self(self, branch.elements);
    }
  };
  for (const Chain& chain : copy.chains) visit(visit, chain.elements);
  std::vector<bool> zeros;
  for (const ParameterPlace& place : parameter_places(copy)) {
    const auto found = before.find(place.element);
    const Actuator* actuator = found == before.end() ? nullptr : found->second;
    const bool turns = actuator != nullptr && actuator->joint.kind == JointKind::revolute;
    zeros.push_back(actuator != nullptr && turns == (place.kind == ParameterKind::orientation) &&
                    std::abs(actuator->joint.axis[place.component % 3]) > 0.999);
  }
  return zeros;
}

/// Geometry has the zeros, too.
bool is_in(ParameterSet set, const std::vector<ParameterSet>& sets) {
  return std::any_of(sets.begin(), sets.end(), [&](ParameterSet s) {
    return s == set || (s == ParameterSet::geometry && set == ParameterSet::zeros);
  });
}

ParameterSet set_of(const Parameter& parameter, bool is_zero) {
  switch (parameter.kind) {
    case ParameterKind::compliance:
      return ParameterSet::compliance;
    case ParameterKind::mass:
      return ParameterSet::mass;
    case ParameterKind::reversal:
      return ParameterSet::reversal;
    case ParameterKind::table:
      return ParameterSet::tables;
    case ParameterKind::harmonic:
      return ParameterSet::harmonics;
    default:
      return is_zero ? ParameterSet::zeros : ParameterSet::geometry;
  }
}

bool has_directions(const Measurements& measurements) {
  for (const Measurement& row : measurements.rows)
    for (const CommandedState& state : row.states)
      if (state.directions != Directions{}) return true;
  return false;
}

}  // namespace

Candidates candidates(const Machine& machine, const Measurements& measurements,
                      const std::vector<ParameterSet>& sets, const KnownParameters& earlier) {
  Candidates result;
  const std::vector<Parameter> all = parameters(machine);
  const std::vector<bool> zeros = zeros_of(machine);
  std::vector<double> before, prior, least;
  std::vector<std::pair<Eigen::Index, Eigen::Index>> known_before;  // here, in `earlier`
  const bool shows_reversal = has_directions(measurements);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].kind == ParameterKind::reversal && !shows_reversal) continue;
    const ParameterSet set = set_of(all[i], zeros[i]);
    if (!is_in(set, sets)) continue;
    PriorDeviation known = prior_deviation(machine, all[i]);
    if (const auto at = std::find(earlier.names.begin(), earlier.names.end(), all[i].name);
        at != earlier.names.end()) {
      const Eigen::Index row = at - earlier.names.begin();
      known = {std::sqrt(earlier.covariance(row, row)), false};
      known_before.emplace_back(static_cast<Eigen::Index>(before.size()), row);
    }
    if (!known.is_default && known.sigma == 0) continue;
    result.varied.push_back(i);
    result.set.push_back(set);
    result.is_default.push_back(known.is_default);
    before.push_back(all[i].value);
    prior.push_back(known.sigma);
    least.push_back(least_value(all[i]));
  }
  const auto n = static_cast<Eigen::Index>(before.size());
  result.before = Eigen::Map<Eigen::VectorXd>(before.data(), n);
  result.prior = Eigen::Map<Eigen::VectorXd>(prior.data(), n);
  result.least = Eigen::Map<Eigen::VectorXd>(least.data(), n);
  result.correlation = Eigen::MatrixXd::Identity(n, n);
  for (const auto& [i, row] : known_before)
    for (const auto& [j, column] : known_before)
      if (i != j)
        result.correlation(i, j) = earlier.covariance(row, column) / (result.prior[i] * result.prior[j]);
  return result;
}

Eigen::VectorXd prior_of(const Candidates& candidates, const std::vector<ParameterSet>& sets) {
  Eigen::VectorXd prior = candidates.prior;
  for (Eigen::Index k = 0; k < prior.size(); ++k)
    if (!is_in(candidates.set[static_cast<std::size_t>(k)], sets)) prior[k] = 0;
  return prior;
}

}  // namespace counterflex
