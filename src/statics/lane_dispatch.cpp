#include "lane_program.hpp"

namespace counterflex::lanes {

void solve_plain(const Program&, const Region&, const Question&, Batch&, double*);
#if defined(__x86_64__)
void solve_avx2(const Program&, const Region&, const Question&, Batch&, double*);
void solve_avx512(const Program&, const Region&, const Question&, Batch&, double*);
#endif

Kernels all_kernels() {
#if defined(__x86_64__)
  Kernels kernels{{{solve_plain, "SSE2", 2}}, 1};
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) kernels.list[kernels.count++] = {solve_avx2, "AVX2", 4};
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
    kernels.list[kernels.count++] = {solve_avx512, "AVX-512", 8};
  return kernels;
#else
  return {{{solve_plain, "plain", 2}}, 1};
#endif
}

Kernel best_kernel() {
  const Kernels kernels = all_kernels();
  return kernels.list[kernels.count - 1];
}

long doubles_needed(const Program& program) {
  constexpr int frame = 12;
  return static_cast<long>(width) *
         (program.states + 2L * program.rows + 2L * program.actuators + frame * program.most_parts);
}

}  // namespace counterflex::lanes
