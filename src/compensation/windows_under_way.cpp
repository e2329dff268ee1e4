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
        flights_(static_cast<std::size_t>(std::clamp(threads_, 1, most_windows))) {}

  std::optional<Failure> run() {
    const auto in_any_order = [this](const WindowStages::Stage& stage) {
      return PipelineStage{
          false, [this, &stage](std::size_t slot, int threads) { step(flights_[slot], threads, stage); }};
    };
    run_pipeline([this](std::size_t slot) { return read(flights_[slot]); },
                 {in_turn(begun_, stages_.begin), in_any_order(stages_.plan),
                  in_turn(written_, stages_.write), in_any_order(stages_.verify)},
                 [this](std::size_t slot) { return deliver(flights_[slot]); }, flights_.size(), threads_);
    return failure_;
  }

 private:
  // Of a stage that takes windows in order: whether one has failed, there or before.
  struct Broken {
    bool is = false;
  };

  bool read(Flight& flight) {
    if (read_.is) return false;
    flight.work = {};
    flight.index = count_++;
    flight.is_read = flight.given_up = flight.waits = false;
    try {
      if (!stages_.next(flight)) return false;
      flight.is_read = true;
      stages_.read(windows_.job(flight.window));
    } catch (...) {
      flight.error = std::current_exception();
      read_.is = true;
    }
    return true;
  }

  void step(Flight& flight, int threads, const WindowStages::Stage& stage) {
    if (!flight.goes_on()) return;
    try {
      Job job = windows_.job(flight.window);
      job.options.threads = threads;
      stage(job, flight);
    } catch (...) {
      flight.error = std::current_exception();
    }
  }

  // What is carried from window to window ends where one has failed.
  PipelineStage in_turn(Broken& broken, const WindowStages::Stage& stage) {
    return {true, [this, &broken, &stage](std::size_t slot, int threads) {
              Flight& flight = flights_[slot];
              flight.given_up = flight.given_up || broken.is;
              step(flight, threads, stage);
              broken.is = !flight.goes_on();
            }};
  }

  bool deliver(Flight& flight) {
    if (flight.is_read) stages_.begun(windows_.job(flight.window));
    if (flight.error) std::rethrow_exception(flight.error);
    stages_.done(windows_.job(flight.window), flight);
    failure_ = flight.work.result.failure;
    return !failure_;
  }

  JobWindows& windows_;
  const int threads_;
  const WindowStages& stages_;
  Broken read_, begun_, written_;
  std::size_t count_ = 0;
  std::vector<Flight> flights_;
  std::optional<Failure> failure_;
};

// Of places that are solved.
constexpr std::size_t large_window = 16 * window_moves;

}  // namespace

void solve_or_wait(const Job& job, bool attribution, Flight& flight) {
  flight.waits = window_size(job.program) > large_window;
  if (flight.waits) return;
  solve_matched(job, attribution, flight.matching, flight.work);
  flight.matching = {};
}

std::optional<Failure> give_out(const Job& job, bool attribution, const WindowEvents& events, Flight& flight) {
  std::optional<Failure> missed;
  const auto take = [&](const std::vector<Waypoint>& some) {
    if (!missed) missed = tolerance_failure(job, some);
    events.solved(job, some);
  };
  if (flight.waits && flight.goes_on())
    solve_matched(job, attribution, flight.matching, flight.work, take);
  else
    take(flight.work.result.waypoints);
  flight.matching = {};
  return missed;
}

std::optional<Failure> run_windows(JobWindows& windows, int threads, const WindowStages& stages) {
  return WindowsUnderWay(windows, threads, stages).run();
}

}  // namespace counterflex
