#if defined(__x86_64__)
#include "statics/kernel/solve_batch.hpp"

namespace counterflex::kernel {

extern const Instance instance_of_4;
const Instance instance_of_4{memory_of<Lanes4>, solve_batch<Lanes4>, 4};

}  // namespace counterflex::kernel
#endif
