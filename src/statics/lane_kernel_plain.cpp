#include "lane_certificate.hpp"

namespace counterflex::lanes {

void solve_plain(const Program& program, const Region& region, const Question& question, Batch& batch, double* memory) {
  LaneKernel<2>::solve(program, region, question, batch, memory);
}

void judge_plain(const Program& program, const Region& region, const Question& question, const Batch& batch, double* memory,
            double* scratch, bool* stable) {
  LaneCertificate<2>::judge(program, region, question, batch, memory, scratch, stable);
}

}  // namespace counterflex::lanes
