#include "statics/kernel/batch.hpp"

namespace counterflex::kernel {

#if defined(__x86_64__)
extern const Instance instance_of_4, instance_of_8;
#endif

std::vector<Instance> all_instances() {
  std::vector<Instance> instances{scalar_instance};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) instances.push_back(instance_of_4);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
    instances.push_back(instance_of_8);
#endif
  return instances;
}

void Batch::clear() {
  for (std::vector<double>* const numbers : {&p, &R, &F, &rho, &lag, &start, &nominal_start})
    numbers->clear();
  cells.clear(), nominal_cells.clear();
  wants_states = wants_pivots = false;
  response_to.reset();
}

Memory& Solver::memory_of(const Problem& problem, const Instance& instance) {
  for (const Kept& kept : kept_)
    if (kept.instance == &instance && kept.problem == problem) return *kept.memory;
  return *kept_.emplace_back(Kept{problem, &instance, instance.memory_of(problem)}).memory;
}

// Sizes are set here: the vectors of an instance must have no code for instructions that a computer lacks.
void Solver::solve(const Problem& problem, const Schedule& schedule, Batch& batch, const Instance* by) {
  static const Instance widest = all_instances().back();
  const FlatMachine& machine = problem.machine();
  const auto count = static_cast<std::size_t>(batch.count());
  if (count == 0) return;
  const auto size = [count](std::vector<double>& numbers, bool is_wanted, std::size_t of_one) {
    numbers.resize(is_wanted ? of_one * count : 0);
  };
  const auto unknowns = static_cast<std::size_t>(machine.unknowns());
  batch.accepted.resize(count), batch.iterations.resize(count), batch.is_stiff.resize(count);
  size(batch.contraction, true, 1);
  size(batch.actuators, true, machine.actuator_joint.size());
  size(batch.tip, problem.real.has_value(), 12);
  size(batch.nominal_tip, problem.nominal.has_value(), 12);
  size(batch.state, batch.wants_states, static_cast<std::size_t>(machine.state_size()));
  size(batch.stress, batch.wants_states, 6 * machine.elements.size());
  size(batch.pivots, batch.wants_pivots, unknowns);
  const std::size_t variables = batch.response_to ? static_cast<std::size_t>(batch.response_to->count()) : 0;
  size(batch.responses, variables > 0, variables * (unknowns + (problem.real ? 6 : 0)));
  size(batch.stress_responses, variables > 0 && problem.real, variables * 6 * machine.elements.size());
  const Instance& instance = by != nullptr ? *by : count == 1 ? scalar_instance : widest;
  instance.solve(memory_of(problem, instance), schedule, batch);
}

}  // namespace counterflex::kernel
