#include "batch/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "batch/job_process.hpp"
#include "batch/progress.hpp"
#include "counterflex/files/input_error.hpp"
#include "counterflex/files/text.hpp"
#include "process/signals.hpp"
#include "process/workers.hpp"

namespace counterflex::cli {
namespace {

constexpr int tick_ms = 250;
constexpr int patience_ms = 400;      // for workers after SIGTERM
constexpr int hesitation_ms = 100;    // until a signal that ended a worker arrives here, too
constexpr double large_share = 0.25;  // of the work of one processor

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds between_progress(250);

/// Indices of jobs that have no outcome yet, the largest first.
std::vector<std::size_t> missing_jobs(const BatchManifest& manifest) {
  std::vector<std::size_t> missing;
  for (std::size_t job = 0; job < manifest.jobs().size(); ++job)
    if (!manifest.outcome(job)) missing.push_back(job);
  std::ranges::stable_sort(missing, std::greater<>(),
                           [&](std::size_t job) { return manifest.jobs()[job]->work; });
  return missing;
}

/// By job: the last ones before it that have one of its data lists.
std::vector<std::vector<std::size_t>> users_before(const BatchJobs& jobs) {
  std::vector<std::vector<std::size_t>> before(jobs.size());
  std::map<std::string, std::size_t> last_user;
  for (std::size_t job = 0; job < jobs.size(); ++job)
    for (const std::string& list : jobs[job]->shared_lists) {
      const auto [user, is_first] = last_user.try_emplace(list, job);
      if (!is_first && user->second != job) before[job].push_back(user->second);
      user->second = job;
    }
  return before;
}

/// Fails a job that has written `path`, as the job of the program `other` has. Removes its outputs: one of
/// them has the contents of the other job.
void fail_for_shared(const std::string& path, const std::string& other, JobOutcome& outcome) {
  if (outcome.error_kind) return;
  std::error_code ignored;
  for (const FileHash& file : outcome.outputs) std::filesystem::remove(file.path, ignored);
  outcome.outputs.clear();
  outcome.error_kind = ErrorKind::usage;
  outcome.verdict = JobOutcome{}.verdict;
  outcome.verdict_reason.clear();
  outcome.error = fmt::format(
      "{}: error: its output {} is also an output of the job of {}, and is removed; give one of the jobs "
      "another folder",
      without_controls(outcome.program), without_controls(path), without_controls(other));
}

/// Tasks of the workers are indices into `missing_`.
class JobsRun {
 public:
  JobsRun(BatchManifest& manifest, int threads, JobFiles& files, Console& console)
      : manifest_(manifest),
        missing_(missing_jobs(manifest)),
        before_(users_before(manifest.jobs())),
        waiting_(missing_.size()),
        threads_(threads),
        files_(files),
        console_(console),
        outcomes_(missing_.size()) {
    for (const JobOutcome& outcome : manifest.ended())
      for (const FileHash& file : outcome.outputs)
        files_.add_output(file.path, {outcome.output, outcome.program});
    std::iota(waiting_.begin(), waiting_.end(), std::size_t{0});
    std::vector<double> work;
    for (std::size_t task = 0; task < missing_.size(); ++task) work.push_back(job(task).work);
    large_ = large_share * std::accumulate(work.begin(), work.end(), 0.0) / threads_;
    progress_ = BatchProgress(std::move(work));
  }

  std::optional<int> run() {
    while (!waiting_.empty() || workers_.running() > 0) {
      start_some();
      for (const WorkerEvent& event : workers_.wait(&signals_, tick_ms)) {
        take(event);
        if (stopped_) break;
      }
      if (!stopped_) stopped_ = signals_.take();
      if (stopped_) {
        workers_.end_all(patience_ms);
        return stopped_;
      }
      manifest_.save_sometimes();
      show_progress();
    }
    return std::nullopt;
  }

 private:
  /// Limits the rate: every window of every job may produce an event.
  void show_progress() {
    const auto now = Clock::now();
    if (shown_ && now - *shown_ < between_progress) return;
    shown_ = now;
    console_.progress_line(progress_.text());
  }

  const BatchJob& job(std::size_t task) const { return *manifest_.jobs()[missing_[task]]; }
  bool is_large(std::size_t task) const { return threads_ > 1 && job(task).work > large_; }

  bool may_start(std::size_t task) const {
    return std::ranges::all_of(before_[missing_[task]],
                               [&](std::size_t job) { return manifest_.outcome(job).has_value(); });
  }

  void start_some() {
    while (static_cast<int>(workers_.running()) < threads_ && !alone_) {
      const auto next = std::ranges::find_if(waiting_, [&](std::size_t task) { return may_start(task); });
      if (next == waiting_.end()) break;
      alone_ = is_large(*next);
      if (alone_ && workers_.running() > 0) break;
      if (!start(*next, alone_ ? threads_ : 1)) break;
      waiting_.erase(next);
    }
  }

  /// Returns false if the system has no free process but one of ours will end.
  bool start(std::size_t task, int threads) {
    try {
      const JobOrder order{job(task).key, threads};
      workers_.start(task, order.text(), [&](const SendLine& send) { do_job(job(task), order, send); });
      return true;
    } catch (const InputError&) {
      if (workers_.running() == 0) throw;
      return false;
    }
  }

  void take(const WorkerEvent& event) {
    if (event.end) return end(event);
    JobNews news = news_of(event.line);
    progress_.add(event.task, news.done, news.waypoints);
    if (news.outcome) outcomes_[event.task] = std::move(news.outcome);
  }

  /// A signal that ends this program may end the worker first. That is not a failure of the job.
  void end(const WorkerEvent& event) {
    std::optional<JobOutcome>& outcome = outcomes_[event.task];
    if (!outcome && (stopped_ = signals_.take(hesitation_ms))) return;
    if (!outcome) outcome = lost_outcome(job(event.task), *event.end);
    if (workers_.running() == 0) alone_ = false;
    add_outputs(*outcome);
    progress_.end(event.task, !outcome->error_kind);
    if (outcome->error_kind) console_.error(outcome->error);
    manifest_.set(missing_[event.task], std::move(*outcome));
  }

  /// Parts and data lists that change are known only now.
  void add_outputs(JobOutcome& outcome) {
    for (const FileHash& file : outcome.outputs) {
      const OutputOwner* other = files_.add_output(file.path, {outcome.output, outcome.program});
      if (other == nullptr) continue;
      const std::string path = file.path;
      fail_other(*other, path, outcome.program);
      return fail_for_shared(path, other->program, outcome);  // removes the outputs
    }
  }

  void fail_other(const OutputOwner& other, const std::string& path, const std::string& program) {
    for (std::size_t job = 0; job < manifest_.jobs().size(); ++job) {
      if (manifest_.jobs()[job]->output != other.output || !manifest_.outcome(job)) continue;
      JobOutcome outcome = *manifest_.outcome(job);
      const bool failed_before = outcome.error_kind.has_value();
      fail_for_shared(path, program, outcome);
      if (!failed_before) console_.error(outcome.error);
      manifest_.set(job, std::move(outcome));
    }
  }

  BatchManifest& manifest_;
  const std::vector<std::size_t> missing_;
  const std::vector<std::vector<std::size_t>> before_;  // by job: others that must have ended
  std::vector<std::size_t> waiting_;                    // tasks, the largest first
  const int threads_;
  JobFiles& files_;
  Console& console_;
  const AwaitedSignals signals_;
  Workers workers_;
  BatchProgress progress_;
  std::vector<std::optional<JobOutcome>> outcomes_;  // of those that have sent one
  double large_ = 0;
  bool alone_ = false;  // a large job runs, or waits for the others to end
  std::optional<int> stopped_;
  std::optional<Clock::time_point> shown_;  // progress
};

}  // namespace

std::optional<int> do_missing(BatchManifest& manifest, int threads, JobFiles& files, Console& console) {
  return JobsRun(manifest, threads, files, console).run();
}

}  // namespace counterflex::cli
