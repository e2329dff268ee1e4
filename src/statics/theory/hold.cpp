#include "counterflex/statics/chain.hpp"
#include "statics/model/tolerances.hpp"
#include "statics/solve/by_parts.hpp"
#include "statics/solve/continuation.hpp"

namespace counterflex {
namespace {

// One chain, from the nominal configuration to the held pose.
Status hold_chain(const Model& model, std::size_t i, const Pose& nominal, const Pose& held, const Stage& goal,
                  SeriesState& state, StaticsWork& work) {
  const Vector6 way = difference(held, nominal);
  Status status = Status::converged;
  by_parts(first_part, smallest_part, [&](double, double s) {
    SeriesState tried = state;
    status = solve_chain(model, i, s < 1 ? moved(nominal, s * way) : held, between(nominal_stage, goal, s),
                         ChainMethod::newton, tried, work)
                 .status;
    if (status != Status::converged) return false;
    state = std::move(tried);
    return true;
  });
  return status;
}

}  // namespace

HeldPlatform hold_platform(const Model& model, const Configuration& nominal, const Pose& X_MP,
                           const Stage& goal, StaticsWork& work) {
  HeldPlatform held{Status::converged, 0, nominal};
  held.configuration.X_MP = X_MP;
  for (std::size_t i = 0; i < nominal.chains.size(); ++i) {
    held.status = hold_chain(model, i, nominal.X_MP, X_MP, goal, held.configuration.chains[i], work);
    held.chain = i;
    if (held.status != Status::converged) break;
  }
  return held;
}

Vector6 holding_wrench(const Configuration& configuration) {
  Vector6 F = Vector6::Zero();
  for (const SeriesState& chain : configuration.chains) F += chain.F;
  return F;
}

Vector6 holding_wrench_at_tip(const Mechanism& mechanism, const Configuration& configuration) {
  return wrench_at(holding_wrench(configuration), -(configuration.X_MP.R * mechanism.X_PT.p));
}

}  // namespace counterflex
