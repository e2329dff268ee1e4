#include "lane_certificate.hpp"

namespace counterflex::lanes {

void solve_avx512(const Program& program, const Region& region, const Question& question, Batch& batch, double* memory) {
  LaneKernel<8>::solve(program, region, question, batch, memory);
}

void judge_avx512(const Program& program, const Region& region, const Question& question, const Batch& batch, double* memory,
            double* scratch, bool* stable) {
  LaneCertificate<8>::judge(program, region, question, batch, memory, scratch, stable);
}

}  // namespace counterflex::lanes
