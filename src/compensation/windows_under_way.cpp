#include "windows_under_way.hpp"

#include <algorithm>

#include "pipeline.hpp"

namespace counterflex {
namespace {

// As many windows at once as threads keep these at work, as the stages in order are the smaller part. Each
// takes some megabytes: there are never more.
constexpr int most_windows = 6;

class WindowsUnderWay {
 public:
  WindowsUnderWay(JobWindows& windows, int threads, const WindowStages& stages)
      : windows_(windows),
        threads_(threads),
        stages_(stages),
        slots_(static_cast<std::size_t>(std::clamp(threads_, 1, most_windows))) {}

  std::optional<Failure> run() {
    const auto in_any_order = [this](const WindowStages::Stage& stage) {
      return PipelineStage{
          false, [this, &stage](std::size_t slot, int threads) { step(slots_[slot], threads, stage); }};
    };
    run_pipeline([this](std::size_t slot) { return read(slots_[slot]); },
                 {in_turn(begun_, stages_.begin), in_any_order(stages_.plan),
                  in_turn(written_, stages_.write), in_any_order(stages_.verify)},
                 [this](std::size_t slot) { return deliver(slots_[slot]); }, slots_.size(), threads_);
    return failure_;
  }

 private:
  // Of a stage that takes windows in order: whether one has failed, there or before.
  struct Broken {
    bool is = false;
  };

  bool read(WindowInProgress& window) {
    if (read_.is) return false;
    window.work = {};
    window.is_read = window.given_up = window.waits = false;
    try {
      if (!stages_.next(window)) return false;
      window.is_read = true;
      stages_.read(windows_.job(window.input));
    } catch (...) {
      window.error = std::current_exception();
      read_.is = true;
    }
    return true;
  }

  void step(WindowInProgress& window, int threads, const WindowStages::Stage& stage) {
    if (!window.goes_on()) return;
    try {
      Job job = windows_.job(window.input);
      job.options.threads = threads;
      stage(job, window);
    } catch (...) {
      window.error = std::current_exception();
    }
  }

  // What is carried from window to window ends where one has failed.
  PipelineStage in_turn(Broken& broken, const WindowStages::Stage& stage) {
    return {true, [this, &broken, &stage](std::size_t slot, int threads) {
              WindowInProgress& window = slots_[slot];
              window.given_up = window.given_up || broken.is;
              step(window, threads, stage);
              broken.is = !window.goes_on();
            }};
  }

  bool deliver(WindowInProgress& window) {
    if (window.is_read) stages_.begun(windows_.job(window.input));
    if (window.error) std::rethrow_exception(window.error);
    stages_.done(windows_.job(window.input), window);
    failure_ = window.work.result.failure;
    return !failure_;
  }

  JobWindows& windows_;
  const int threads_;
  const WindowStages& stages_;
  Broken read_, begun_, written_;
  std::vector<WindowInProgress> slots_;
  std::optional<Failure> failure_;
};

// Of places that are solved.
constexpr std::size_t large_window = 16 * window_moves;

}  // namespace

void solve_or_wait(const Job& job, bool attribution, WindowInProgress& window) {
  window.waits = window_size(job.program) > large_window;
  if (window.waits) return;
  solve_matched(job, attribution, window.matching, window.work);
  window.matching = {};
}

std::optional<Failure> give_out(const Job& job, bool attribution, const WindowEvents& events,
                                WindowInProgress& window) {
  std::optional<Failure> missed;
  const auto take = [&](const std::vector<Waypoint>& some) {
    if (!missed) missed = tolerance_failure(job, some);
    events.solved(job, some);
  };
  if (window.waits && window.goes_on())
    solve_matched(job, attribution, window.matching, window.work, take);
  else
    take(window.work.result.waypoints);
  window.matching = {};
  return missed;
}

std::optional<Failure> run_windows(JobWindows& windows, int threads, const WindowStages& stages) {
  return WindowsUnderWay(windows, threads, stages).run();
}

}  // namespace counterflex
