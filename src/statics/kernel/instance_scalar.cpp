#include "statics/kernel/solve_batch.hpp"

namespace counterflex::kernel {

const Instance scalar_instance{memory_of<double>, solve_batch<double>, 1};

}  // namespace counterflex::kernel
