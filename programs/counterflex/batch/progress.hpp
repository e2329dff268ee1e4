#pragma once
/// Progress of a batch.
#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace counterflex::cli {

class BatchProgress {
 public:
  BatchProgress() = default;

  /// `work` of the jobs, in any unit.
  explicit BatchProgress(std::vector<double> work);

  /// A job has done this share of its work, and has solved `waypoints` more.
  void add(std::size_t job, std::optional<double> share, std::size_t waypoints);

  /// A job has ended.
  void end(std::size_t job, bool done);

  /// "[##------------------]  12 %, 34000 waypoints/s, 2 min left, 12 of 200 jobs, 1 failed".
  std::string text() const;

 private:
  double done_work() const;

  std::vector<double> work_, done_;  // by job
  double all_work_ = 0;
  std::size_t ended_ = 0, failed_ = 0, waypoints_ = 0;
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

}  // namespace counterflex::cli
