#include "statics/model/home_reference.hpp"

#include "counterflex/statics/equilibrium.hpp"
#include "statics/model/tolerances.hpp"

namespace counterflex {

void hold_home(Model& model) {
  StaticsWork work(model.mechanism);
  const Stage by_weight{.errors = 0, .load = 0};
  const Equilibrium held =
      solve_target(model, model.home, tip(model.mechanism, model.home), {}, by_weight, work);
  model.gravity_status = held.status;
  if (held.status != Status::converged) return;
  const Eigen::VectorXd offsets =
      actuator_values(model.mechanism, held.configuration) - actuator_values(model.mechanism, model.home);
  // Without weights and preloads home is the zero as it is; the noise of solving would set others.
  if (offsets.size() > 0 && offsets.cwiseAbs().maxCoeff() > closure_tolerance)
    set_zero_offsets(offsets, model.mechanism);
}

}  // namespace counterflex
