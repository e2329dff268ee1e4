#include "batch/progress.hpp"

#include <fmt/format.h>

#include <numeric>
#include <utility>

#include "process/progress.hpp"

namespace counterflex::cli {
BatchProgress::BatchProgress(std::vector<double> work) : work_(std::move(work)), done_(work_.size()) {
  all_work_ = std::accumulate(work_.begin(), work_.end(), 0.0);
}

void BatchProgress::add(std::size_t job, std::optional<double> share, std::size_t waypoints) {
  if (share) done_[job] = *share * work_[job];
  waypoints_ += waypoints;
}

void BatchProgress::end(std::size_t job, bool done) {
  done_[job] = work_[job];
  ++ended_;
  if (!done) ++failed_;
}

double BatchProgress::done_work() const {
  return std::accumulate(done_.begin(), done_.end(), 0.0);
}

std::string BatchProgress::text() const {
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
  std::string text = fmt::format("{} of {} jobs", ended_, work_.size());
  if (failed_ > 0) text += fmt::format(", {} failed", failed_);
  return progress_bar({all_work_ > 0 ? done_work() / all_work_ : 0, waypoints_, elapsed}) + ", " + text;
}

}  // namespace counterflex::cli
