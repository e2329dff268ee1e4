#include "batch_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <numeric>

#include "batch_progress.hpp"
#include "counterflex/files/input_error.hpp"
#include "job_process.hpp"

namespace counterflex::cli {
namespace {

constexpr int tick_ms = 250;
constexpr int patience_ms = 400;      // for workers that are asked to end
constexpr int hesitation_ms = 100;    // for a signal that has ended a worker to arrive here, too
constexpr double large_share = 0.25;  // of what one processor has to do in all

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds between_progress(250);

class TaskRun {
 public:
  TaskRun(const std::vector<BatchTask>& tasks, int threads, const AwaitedSignals& signals,
          const BatchListener& listener, Console& console)
      : tasks_(tasks),
        threads_(threads),
        signals_(signals),
        listener_(listener),
        console_(console),
        progress_(tasks),
        outcomes_(tasks.size()),
        order_(tasks.size()) {
    console_.never_wait();
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::size_t a, std::size_t b) { return tasks_[a].work > tasks_[b].work; });
    for (const BatchTask& task : tasks_) large_ += large_share * task.work / threads_;
  }

  std::optional<int> run() {
    while (next_ < order_.size() || workers_.running() > 0) {
      start_some();
      for (const WorkerEvent& event : workers_.wait(signals_.descriptor(), tick_ms)) {
        hear(event);
        if (stopped_) break;
      }
      if (!stopped_) stopped_ = signals_.take();
      if (stopped_) {
        workers_.end_all(patience_ms);
        return stopped_;
      }
      listener_.now_and_then();
      show_progress();
    }
    return std::nullopt;
  }

 private:
  /// Nobody reads it faster, and there may be an event of every window of every job.
  void show_progress() {
    const auto now = Clock::now();
    if (shown_ && now - *shown_ < between_progress) return;
    shown_ = now;
    console_.progress_line(progress_.text());
  }

  bool is_large(std::size_t task) const { return threads_ > 1 && tasks_[task].work > large_; }

  void start_some() {
    while (next_ < order_.size() && static_cast<int>(workers_.running()) < threads_ && !alone_) {
      const std::size_t task = order_[next_];
      alone_ = is_large(task);
      if (alone_ && workers_.running() > 0) break;
      if (!start(task, alone_ ? threads_ : 1)) break;
      ++next_;
    }
  }

  /// A system that has no more processes may have some when one of these has ended: false.
  bool start(std::size_t task, int threads) {
    try {
      workers_.start(task, [&](const SendLine& send) { tasks_[task].run(threads, send); });
      return true;
    } catch (const InputError&) {
      if (workers_.running() == 0) throw;
      return false;
    }
  }

  void hear(const WorkerEvent& event) {
    if (event.ended) return end(event);
    JobNews news = news_of(event.line);
    progress_.add(event.task, news.done, news.waypoints);
    if (news.outcome) outcomes_[event.task] = std::move(news.outcome);
  }

  /// The signal that ends this program may have ended the worker first: nothing is wrong with it then.
  void end(const WorkerEvent& event) {
    std::optional<JobOutcome>& outcome = outcomes_[event.task];
    if (!outcome && (stopped_ = signals_.take(hesitation_ms))) return;
    if (!outcome) outcome = tasks_[event.task].lost(event.status);
    if (workers_.running() == 0) alone_ = false;
    progress_.end(event.task, outcome->exit == Exit::done);
    if (outcome->exit != Exit::done) console_.error(outcome->error);
    listener_.ended(event.task, std::move(*outcome));
  }

  const std::vector<BatchTask>& tasks_;
  const int threads_;
  const AwaitedSignals& signals_;
  const BatchListener& listener_;
  Console& console_;
  BatchProgress progress_;
  Workers workers_;
  std::vector<std::optional<JobOutcome>> outcomes_;  // of those that have sent one
  std::vector<std::size_t> order_;                   // the largest first
  std::size_t next_ = 0;                             // in that order
  double large_ = 0;
  bool alone_ = false;  // a large task runs, or waits for the others to end
  std::optional<int> stopped_;
  std::optional<Clock::time_point> shown_;  // progress
};

}  // namespace

std::optional<int> run_tasks(const std::vector<BatchTask>& tasks, int threads, const AwaitedSignals& signals,
                             const BatchListener& listener, Console& console) {
  return TaskRun(tasks, threads, signals, listener, console).run();
}

}  // namespace counterflex::cli
