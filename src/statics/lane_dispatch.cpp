#include "lane_program.hpp"

namespace counterflex::lanes {

void solve_plain(const Program&, const Region&, const Question&, Batch&, double*);
void judge_plain(const Program&, const Region&, const Question&, const Batch&, double*, double*, bool*);
#if defined(__x86_64__)
void solve_avx2(const Program&, const Region&, const Question&, Batch&, double*);
void judge_avx2(const Program&, const Region&, const Question&, const Batch&, double*, double*, bool*);
void solve_avx512(const Program&, const Region&, const Question&, Batch&, double*);
void judge_avx512(const Program&, const Region&, const Question&, const Batch&, double*, double*, bool*);
#endif

Kernels all_kernels() {
#if defined(__x86_64__)
  Kernels kernels{{{solve_plain, judge_plain, "SSE2", 2}}, 1};
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    kernels.list[kernels.count++] = {solve_avx2, judge_avx2, "AVX2", 4};
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
    kernels.list[kernels.count++] = {solve_avx512, judge_avx512, "AVX-512", 8};
  return kernels;
#else
  return {{{solve_plain, judge_plain, "plain", 2}}, 1};
#endif
}

Kernel best_kernel() {
  const Kernels kernels = all_kernels();
  return kernels.list[kernels.count - 1];
}

long doubles_needed(const Program& program) {
  constexpr int frame = 12, weights = 12;
  return static_cast<long>(width) *
         (program.states + 2L * program.rows + 2L * program.actuators + frame * program.most_parts +
          weights * program.series_count);
}

long doubles_of_certificate(const Program& program) {
  const long n = program.most_free;
  return width * (36L * program.series_count + 18 * n + n * n);
}

}  // namespace counterflex::lanes
