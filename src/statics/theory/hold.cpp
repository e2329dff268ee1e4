#include "counterflex/statics/chain.hpp"

#include <algorithm>

namespace counterflex {
namespace {

constexpr double first_hold_step = 0.25, smallest_hold_step = 1.0 / 1024;

// One chain, from the nominal configuration to the held pose.
Status hold_chain(const Model& model, std::size_t i, const Pose& nominal, const Pose& held, const Stage& goal,
                  SeriesState& state, StaticsWork& work) {
  const Vector6 way = difference(held, nominal);
  double s = 0, step = first_hold_step;
  while (s < 1) {
    const double next = std::min(1.0, s + step);
    const Stage stage{next * goal.errors, next * goal.load, next * goal.preload, next * goal.gravity};
    SeriesState tried = state;
    const Status status =
        solve_chain(model, i, next < 1 ? moved(nominal, next * way) : held, stage, ChainMethod::newton, tried, work).status;
    if (status != Status::converged) {
      if ((step /= 2) < smallest_hold_step) return status;
      continue;
    }
    state = std::move(tried);
    s = next;
  }
  return Status::converged;
}

}  // namespace

HeldPlatform hold_platform(const Model& model, const Configuration& nominal, const Pose& X_MP, const Stage& goal,
                           StaticsWork& work) {
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
