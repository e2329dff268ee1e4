#include "lane_program.hpp"

namespace counterflex::lanes {

void solve_plain(const Program&, const Region&, const Question&, Batch&, double*);
#if defined(__x86_64__)
void solve_avx2(const Program&, const Region&, const Question&, Batch&, double*);
void solve_avx512(const Program&, const Region&, const Question&, Batch&, double*);
#endif

Kernel best_kernel() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("fma")) return {solve_avx512, "AVX-512", 8};
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return {solve_avx2, "AVX2", 4};
  return {solve_plain, "SSE2", 2};
#else
  return {solve_plain, "plain", 2};
#endif
}

long doubles_needed(const Program& program) {
  constexpr int frame = 12;
  return static_cast<long>(width) * (program.states + 2L * program.rows + 2L * program.actuators + frame * program.most_parts);
}

}  // namespace counterflex::lanes
