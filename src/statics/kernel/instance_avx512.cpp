#if defined(__x86_64__)
#include "statics/kernel/solve_batch.hpp"

namespace counterflex::kernel {

extern const Instance instance_of_8;
const Instance instance_of_8{memory_of<Lanes8>, solve_batch<Lanes8>, 8};

}  // namespace counterflex::kernel
#endif
