#include "counterflex/statics/equilibrium.hpp"

#include "counterflex/statics/chain.hpp"
#include "statics/model/tolerances.hpp"
#include "statics/solve/continuation.hpp"

namespace counterflex {

StaticsWork::StaticsWork(const Mechanism& mechanism)
    : impl_(std::make_unique<Impl>(Impl{{}, kernel::Single(mechanism)})) {
  for (const Series& chain : mechanism.chains) impl_->chains.push_back(make_work(chain));
}
StaticsWork::~StaticsWork() = default;
StaticsWork::StaticsWork(StaticsWork&&) noexcept = default;

Equilibrium solve_forward(const Model& model, const Configuration& nominal, const Load& load,
                          const Stage& goal, StaticsWork& work) {
  return continue_from(model, nominal, nominal_stage, {load, goal, nullptr}, newton, work.impl());
}

Equilibrium refine_forward(const Model& model, const Configuration& start, const Load& load,
                           const Stage& goal, StaticsWork& work) {
  return refine(model, start, {load, goal, nullptr}, newton, work.impl());
}

Equilibrium equilibrium_at(const Model& model, const Configuration& nominal, const Load& load,
                           const Stage& goal, const Pose& X_MT, StaticsWork& work) {
  Equilibrium found = refine_forward(model, nominal, load, goal, work);
  if (found.status != Status::converged) return found;
  const Vector6 apart = difference(tip(model.mechanism, found.configuration), X_MT);
  if (apart.cwiseQuotient(Units{model.mechanism.length}.of_pose()).norm() > known_tip)
    found.status = Status::not_converged;
  return found;
}

bool is_reached_by_load_alone(const Model& model, const Configuration& nominal, const Load& load,
                              const Stage& goal, const Equilibrium& loaded, StaticsWork& work) {
  Stage unloaded = goal;
  unloaded.load = 0;
  const Equilibrium rest = solve_forward(model, nominal, load, unloaded, work);
  if (rest.status != Status::converged) return true;
  const Equilibrium found = continue_from(model, rest.configuration, unloaded, {load, goal, nullptr}, newton,
                                          work.impl(), Watch::ways);
  const Vector6 apart = difference(found.configuration.X_MP, loaded.configuration.X_MP);
  return found.status == Status::converged &&
         apart.cwiseQuotient(Units{model.mechanism.length}.of_pose()).norm() <= same_place;
}

Equilibrium solve_target(const Model& model, const Configuration& nominal, const Pose& X_MT, const Load& load,
                         const Stage& goal, StaticsWork& work) {
  return continue_from(model, nominal, nominal_stage, {load, goal, &X_MT}, newton, work.impl());
}

Equilibrium refine_target(const Model& model, const Configuration& start, const Pose& X_MT, const Load& load,
                          const Stage& goal, StaticsWork& work) {
  return refine(model, start, {load, goal, &X_MT}, newton, work.impl());
}

ManipulatorStiffness stiffness(const Model& model, const Configuration& configuration, const Stage& stage,
                               StaticsWork& work) {
  evaluate_all(model, configuration, stage, work.impl());
  const auto sum = aggregate(model.mechanism.chains, {model.mechanism.length}, work.impl().chains);
  if (sum) return {sum->K, true};
  ManipulatorStiffness uncondensed;
  for (std::size_t i = 0; i < model.mechanism.chains.size(); ++i) {
    const ChainStiffness chain = chain_stiffness(model, i, configuration.chains[i], stage, work);
    if (!chain.available) return {Matrix6::Zero(), false};
    uncondensed.K += chain.K_C;
  }
  return uncondensed;
}

double stability(const Model& model, const Configuration& configuration, const Load& load, const Stage& stage,
                 StaticsWork& work) {
  return least_eigenvalue(model, configuration, {load, stage, nullptr}, work.impl());
}

double static_condition(const Model& model, const Configuration& configuration, const Load& load,
                        const Stage& stage, StaticsWork& work) {
  evaluate_all(model, configuration, stage, work.impl());
  return condition(whole_system(model, configuration, {load, stage, nullptr}, work.impl()),
                   {model.mechanism.length})
      .value;
}

}  // namespace counterflex
