#include "home_reference.hpp"

#include "counterflex/statics/equilibrium.hpp"

namespace counterflex {

void hold_home(Model& model) {
  StaticsWork work(model.mechanism);
  const Stage by_weight{.errors = 0, .load = 0};
  const Equilibrium held =
      solve_target(model, model.home, tip(model.mechanism, model.home), {}, by_weight, work);
  model.gravity_status = held.status;
  if (held.status != Status::converged) return;
  const Eigen::VectorXd found = actuator_values(model.mechanism, held.configuration);
  set_zero_offsets(found - actuator_values(model.mechanism, model.home), model.mechanism);
}

}  // namespace counterflex
