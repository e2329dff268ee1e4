#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "compensation/windows/window_steps.hpp"

namespace counterflex {
namespace {

// Items that several threads take through steps at once. Some steps take the items in their order.
class Turns {
 public:
  /// `steps`: of those that take items in order.
  Turns(int threads, std::size_t steps) : threads_(threads), next_(steps) {}

  /// Calls `work` on `workers` threads, one of which is the calling one. Each takes one item after another
  /// through all of its steps. Throws the first thing that a step in order has thrown.
  void run(std::size_t workers, const std::function<void()>& work) {
    active_ = static_cast<int>(workers);
    const auto worker = [&] {
      work();
      const std::lock_guard lock(mutex_);
      --active_;
    };
    {
      std::vector<std::jthread> others;
      for (std::size_t t = 1; t < workers; ++t) others.emplace_back(worker);
      worker();
    }
    if (thrown_) std::rethrow_exception(thrown_);
  }

  /// The number of the next item.
  std::size_t take() { return items_++; }

  /// Calls `work` when all items before have had this step. False if the run was stopped before that, or by
  /// `work`.
  bool in_turn(std::size_t step, std::size_t item, const std::function<void()>& work) {
    std::unique_lock lock(mutex_);
    --active_;
    changed_.wait(lock, [&] { return stopped_ || next_[step] == item; });
    ++active_;
    if (stopped_) return false;
    lock.unlock();
    std::exception_ptr thrown;
    try {
      work();
    } catch (...) {
      thrown = std::current_exception();
    }
    lock.lock();
    ++next_[step];
    if (thrown && !thrown_) thrown_ = thrown;
    stopped_ = stopped_ || thrown;
    changed_.notify_all();
    return !stopped_;
  }

  /// No step in order begins from now on.
  void stop() {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    changed_.notify_all();
  }

  /// How many threads a step out of order may use now.
  int free_threads() {
    const std::lock_guard lock(mutex_);
    return std::max(1, threads_ / std::max(1, active_));
  }

 private:
  const int threads_;
  std::atomic<std::size_t> items_{0};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::size_t> next_;  // by step: the item that comes next
  int active_ = 0;                 // workers that do not wait
  bool stopped_ = false;
  std::exception_ptr thrown_{};
};

// As many windows at once as there are threads: the steps in order are the smaller part. Each window takes
// some megabytes, so there are never more than this.
constexpr std::size_t most_windows = 6;

// Places of a window whose waypoints are solved and given out in portions, when all windows before it are
// done.
constexpr std::size_t large_window = 16 * window_moves;

// A window, the error that waits until all windows before it are done, and whether one before it has failed.
struct WindowInProgress {
  JobWindow input{};
  WindowWork work{};
  bool is_read = false, given_up = false;
  std::exception_ptr error{};

  bool may_continue() const { return !given_up && !error && !work.failed(); }
};

class WindowRun {
 public:
  WindowRun(JobWindows& windows, int threads, const WindowSteps& steps, const WindowEvents& events)
      : windows_(windows), threads_(threads), steps_(steps), events_(events), turns_(threads, in_order) {}

  std::optional<Failure> run() {
    turns_.run(std::clamp<std::size_t>(static_cast<std::size_t>(threads_), 1, most_windows),
               [this] { work(); });
    return failure_;
  }

 private:
  enum { reading, writing, delivery, in_order };  // the steps in order

  // One window after another.
  void work() {
    WindowInProgress window;
    for (;;) {
      const std::size_t item = turns_.take();
      bool found = false;
      if (!turns_.in_turn(reading, item, [&] { found = read(window); }) || !found) return;
      step(window, turns_.free_threads(), steps_.prepare);
      const auto write = [&] {
        window.given_up = has_failed_;
        step(window, 1, steps_.write);
        has_failed_ = !window.may_continue();
      };
      if (!turns_.in_turn(writing, item, write)) return;
      const int threads = turns_.free_threads();
      step(window, threads, steps_.match);
      if (!is_large(window)) step(window, threads, [this](const Job& job, WindowWork& w) { solve(job, w); });
      if (!turns_.in_turn(delivery, item, [&] { deliver(window); })) return;
    }
  }

  bool read(WindowInProgress& window) {
    if (all_read_) return false;
    window.work = {};
    window.is_read = window.given_up = false;
    window.error = nullptr;
    try {
      all_read_ = !windows_.next(window.input);
      if (all_read_) return false;
      window.is_read = true;
      events_.read(windows_.job(window.input));
    } catch (...) {
      window.error = std::current_exception();
      all_read_ = true;
    }
    return true;
  }

  void step(WindowInProgress& window, int threads, const WindowSteps::Step& take) {
    if (!take || !window.may_continue()) return;
    try {
      Job job = windows_.job(window.input);
      job.options.threads = threads;
      take(job, window.work);
    } catch (...) {
      window.error = std::current_exception();
    }
  }

  static bool is_large(const WindowInProgress& window) {
    return window_size(window.input.program) > large_window;
  }

  void solve(const Job& job, WindowWork& work) const {
    ForwardRun run = solve_pieces(job, work.pieces, steps_.questions, work.command);
    work.pieces = {};
    work.result.waypoints = std::move(run.waypoints);
    work.result.failure = std::move(run.failure);
  }

  void deliver(WindowInProgress& window) {
    if (window.is_read) events_.begun(windows_.job(window.input));
    if (window.error) std::rethrow_exception(window.error);
    Job job = windows_.job(window.input);
    job.options.threads = threads_;
    WindowWork& work = window.work;
    std::optional<Failure> missed;
    const auto take = [&](const std::vector<Waypoint>& some) {
      if (!missed) missed = tolerance_failure(job, some);
      events_.solved(job, some);
    };
    if (is_large(window) && !work.failed())
      work.result.failure = solve_in_portions(job, work.pieces, steps_.questions, work.command, take);
    else
      take(work.result.waypoints);
    if (steps_.judge) steps_.judge(work, missed);
    events_.done(job, work.result);
    failure_ = work.result.failure;
    if (failure_) turns_.stop();
  }

  JobWindows& windows_;
  const int threads_;
  const WindowSteps& steps_;
  const WindowEvents& events_;
  Turns turns_;
  bool all_read_ = false;    // of the step `reading`
  bool has_failed_ = false;  // of the step `writing`: no window behind it can be written
  std::optional<Failure> failure_;
};

}  // namespace

std::optional<Failure> run_windows(JobWindows& windows, int threads, const WindowSteps& steps,
                                   const WindowEvents& events) {
  return WindowRun(windows, threads, steps, events).run();
}

}  // namespace counterflex
