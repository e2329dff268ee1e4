#include "lane_kernel.hpp"

namespace counterflex::lanes {

void solve_avx2(const Program& program, const Region& region, const Question& question, Batch& batch, double* memory) {
  LaneKernel<4>::solve(program, region, question, batch, memory);
}

}  // namespace counterflex::lanes
