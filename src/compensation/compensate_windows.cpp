#include "counterflex/compensation/compensate_windows.hpp"

#include <algorithm>
#include <exception>

#include "pipeline.hpp"
#include "window_stages.hpp"

namespace counterflex {
namespace {

// As many windows at once as threads keep these at work, as the stages in order are the smaller part. Each
// takes some megabytes: there are never more.
constexpr int most_windows = 6;

// A window under way. An error waits until all windows before it are done.
struct Flight {
  JobWindow window{};
  WindowWork work{};
  bool is_read = false;
  bool given_up = false;  // a window before it has failed
  std::exception_ptr error{};

  bool goes_on() const { return !given_up && !error && !work.failed(); }
};

class WindowsUnderWay {
 public:
  WindowsUnderWay(JobWindows& windows, const CompensationOptions& options, TextReader corrected,
                  bool attribution, const WindowEvents& events)
      : windows_(windows),
        threads_(options.threads),
        attribution_(attribution),
        events_(events),
        carried_{Rewriter(options.write), std::move(corrected)},
        flights_(static_cast<std::size_t>(std::clamp(threads_, 1, most_windows))) {}

  std::optional<Failure> run() {
    const std::vector<PipelineStage> stages{
        {true,
         in_turn(begun_, [this](const Job& job, WindowWork& work) { begin_window(job, carried_, work); })},
        {false, [this](std::size_t slot, int threads) { step(slot, threads, plan_window); }},
        {true,
         in_turn(written_, [this](const Job& job, WindowWork& work) { write_window(job, carried_, work); })},
        {false, [this](std::size_t slot, int threads) {
           step(slot, threads,
                [this](const Job& job, WindowWork& work) { verify_window(job, attribution_, work); });
         }}};
    run_pipeline([this](std::size_t slot) { return read(slot); }, stages,
                 [this](std::size_t slot) { return deliver(slot); }, flights_.size(), threads_);
    return failure_;
  }

 private:
  // Of a stage that takes windows in order: whether one has failed, there or before.
  struct Broken {
    bool is = false;
  };

  bool read(std::size_t slot) {
    if (read_.is) return false;
    Flight& flight = flights_[slot];
    flight.work = {};
    flight.is_read = flight.given_up = false;
    try {
      if (!windows_.next(flight.window)) return false;
      flight.is_read = true;
      events_.read(windows_.job(flight.window));
    } catch (...) {
      flight.error = std::current_exception();
      read_.is = true;
    }
    return true;
  }

  template <typename Work>
  void step(std::size_t slot, int threads, const Work& work) {
    Flight& flight = flights_[slot];
    if (!flight.goes_on()) return;
    try {
      Job job = windows_.job(flight.window);
      job.options.threads = threads;
      work(job, flight.work);
    } catch (...) {
      flight.error = std::current_exception();
    }
  }

  // What is carried from window to window ends where one has failed.
  template <typename Work>
  std::function<void(std::size_t, int)> in_turn(Broken& broken, const Work& work) {
    return [this, &broken, work](std::size_t slot, int threads) {
      Flight& flight = flights_[slot];
      flight.given_up = flight.given_up || broken.is;
      step(slot, threads, work);
      broken.is = !flight.goes_on();
    };
  }

  bool deliver(std::size_t slot) {
    Flight& flight = flights_[slot];
    if (flight.is_read) events_.begun(windows_.job(flight.window));
    if (flight.error) std::rethrow_exception(flight.error);
    events_.done(windows_.job(flight.window), flight.work.result);
    failure_ = flight.work.result.failure;
    return !failure_;
  }

  JobWindows& windows_;
  const int threads_;
  const bool attribution_;
  const WindowEvents& events_;
  CarriedState carried_;
  Broken read_, begun_, written_;
  std::vector<Flight> flights_;
  std::optional<Failure> failure_;
};

}  // namespace

std::optional<Failure> compensate_windows(JobWindows& windows, const CompensationOptions& options,
                                          TextReader corrected, bool attribution,
                                          const WindowEvents& events) {
  return WindowsUnderWay(windows, options, std::move(corrected), attribution, events).run();
}

}  // namespace counterflex
