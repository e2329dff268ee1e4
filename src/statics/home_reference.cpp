#include "home_reference.hpp"

#include "counterflex/statics/equilibrium.hpp"

namespace counterflex {
namespace {

void set_offsets(Series& series, const Eigen::VectorXd& offsets) {
  for (Part& part : series.parts)
    if (part.kind == PartKind::actuator) part.offset = offsets[part.actuator];
  for (SeriesGroup& group : series.groups)
    for (Series& branch : group.branches) set_offsets(branch, offsets);
}

}  // namespace

void hold_home(Model& model) {
  StaticsWork work(model.mechanism);
  const Stage by_weight{0, 0, 1, 1};
  const Equilibrium held =
      solve_target(model, model.home, tip(model.mechanism, model.home), {}, by_weight, work);
  model.gravity_status = held.status;
  if (held.status != Status::converged) return;
  const Eigen::VectorXd offsets =
      actuator_values(model.mechanism, held.configuration) - actuator_values(model.mechanism, model.home);
  for (Series& chain : model.mechanism.chains) set_offsets(chain, offsets);
}

}  // namespace counterflex
