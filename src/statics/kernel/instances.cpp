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

const Instance& instance_for(std::size_t waypoints) {
  static const Instance widest = all_instances().back();
  return waypoints == 1 ? scalar_instance : widest;
}

}  // namespace counterflex::kernel
