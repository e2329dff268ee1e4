#include "batch/progress.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <utility>

namespace counterflex::cli {
namespace {

constexpr double settled = 2;  // s: earlier there is no estimate of the time left

}  // namespace

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

double BatchProgress::time_left(double elapsed) const {
  const double done = std::accumulate(done_.begin(), done_.end(), 0.0);
  return done > 0 ? elapsed * (all_work_ - done) / done : 0;
}

std::string BatchProgress::text() const {
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
  std::string text = fmt::format("{} of {} jobs", ended_, work_.size());
  if (failed_ > 0) text += fmt::format(", {} failed", failed_);
  if (elapsed < settled) return text;
  text += fmt::format(", {:.0f} waypoints/s", static_cast<double>(waypoints_) / elapsed);
  const double left = time_left(elapsed);
  return left > 0 ? text + fmt::format(", {} left", duration_text(left)) : text;
}

std::string duration_text(double seconds) {
  if (seconds < 99.5) return fmt::format("{:.0f} s", seconds);
  const auto minutes = static_cast<long>(std::round(seconds / 60));
  if (minutes < 100) return fmt::format("{} min", minutes);
  return fmt::format("{} h {} min", minutes / 60, minutes % 60);
}

}  // namespace counterflex::cli
