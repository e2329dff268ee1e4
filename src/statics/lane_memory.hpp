#pragma once
/// A kernel's memory and one batch, for one thread.
#include <array>
#include <cstdlib>
#include <memory>
#include <vector>

#include "lane_model.hpp"

namespace counterflex {

class LaneMemory {
 public:
  explicit LaneMemory(const LaneModel& model, lanes::Kernel kernel = lanes::best_kernel());

  /// Solves the batch with what a region shares.
  void solve(const lanes::Region& region, const lanes::Question& question) {
    kernel_.solve(model_.program(), region, question, batch, memory_.get());
  }

  /// Which lanes of that, with the same region and question, are proven stable.
  std::array<bool, lanes::width> stable(const lanes::Region& region, const lanes::Question& question);

  /// The state of a lane after that, without where it stands: it may be the start of others.
  std::vector<double> state(int lane) const;

  /// The largest wrench at the end of a series in a lane (N, N m).
  double largest_wrench(int lane) const;

  double rho(std::size_t actuator, int lane) const { return rho_[actuator * lanes::width + static_cast<std::size_t>(lane)]; }

  lanes::Batch batch{};

 private:
  struct Free {
    void operator()(double* memory) const { std::free(memory); }
  };

  const LaneModel& model_;
  const lanes::Kernel kernel_;
  std::unique_ptr<double, Free> memory_, scratch_;  ///< the second of the certificate
  std::vector<double> rho_;
};

/// A request as one lane of a batch.
inline void put_in_lane(const Vector3& p, const Vector6& F, int lane, lanes::Batch& batch) {
  for (int i = 0; i < 3; ++i) batch.p[i][lane] = p[i];
  for (int i = 0; i < 6; ++i) batch.F[i][lane] = F[i];
}

}  // namespace counterflex
