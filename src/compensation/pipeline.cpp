#include "pipeline.hpp"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

namespace counterflex {
namespace {

// Steps of an item: it begins, goes through the stages, ends.
class Pipeline {
 public:
  Pipeline(const std::function<bool(std::size_t)>& begin, const std::vector<PipelineStage>& stages,
           const std::function<bool(std::size_t)>& end, std::size_t slots, int threads)
      : begin_(begin),
        stages_(stages),
        end_(end),
        threads_(threads),
        steps_(stages.size() + 2),
        next_(steps_),
        at_(slots) {
    for (std::size_t s = 0; s < slots; ++s) at_[s].item = s;
  }

  void run() {
    const auto workers = std::min<std::size_t>(static_cast<std::size_t>(threads_), at_.size());
    {
      std::vector<std::jthread> others;
      for (std::size_t t = 1; t < workers; ++t) others.emplace_back([this] { work(); });
      work();
    }
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  struct Place {
    std::size_t item = 0;  // that is in the slot, or will come into it
    std::size_t step = 0;  // that is under way, or comes next
    bool runs = false;
  };
  struct Task {
    std::size_t slot, step;
    int threads;
  };

  bool in_order(std::size_t step) const {
    return step == 0 || step + 1 == steps_ || stages_[step - 1].in_order;
  }

  // The oldest item that can go on.
  std::optional<Task> pick() {
    std::optional<std::size_t> found;
    for (std::size_t s = 0; s < at_.size(); ++s) {
      const Place& place = at_[s];
      const bool waits = place.runs || (place.step == 0 && no_more_) ||
                         (in_order(place.step) && next_[place.step] != place.item);
      if (!waits && (!found || place.item < at_[*found].item)) found = s;
    }
    if (!found) return std::nullopt;
    Place& place = at_[*found];
    place.runs = true;
    const int threads = in_order(place.step) ? 1 : std::max(1, threads_ - busy_);
    busy_ += threads;
    return Task{*found, place.step, threads};
  }

  // False: the item is none (a first step), or the last that anybody wants (a last one).
  bool perform(const Task& task) {
    if (task.step == 0) return begin_(task.slot);
    if (task.step + 1 == steps_) return end_(task.slot);
    stages_[task.step - 1].work(task.slot, task.threads);
    return true;
  }

  void finish(const Task& task, bool goes_on) {
    Place& place = at_[task.slot];
    busy_ -= task.threads;
    place.runs = false;
    ++next_[task.step];
    if (!goes_on && task.step == 0) no_more_ = true;
    if (!goes_on && task.step > 0) stopped_ = true;
    if (!goes_on) return;
    const bool leaves = ++place.step == steps_;
    if (!leaves) return;
    place.step = 0;
    place.item += at_.size();
  }

  bool has_ended() const {
    const auto is_done = [](const Place& place) { return place.step == 0 && !place.runs; };
    return stopped_ || (no_more_ && std::all_of(at_.begin(), at_.end(), is_done));
  }

  void work() {
    std::unique_lock lock(mutex_);
    while (!has_ended()) {
      const std::optional<Task> task = pick();
      if (!task) {
        changed_.wait(lock);
        continue;
      }
      lock.unlock();
      std::exception_ptr thrown;
      bool goes_on = false;
      try {
        goes_on = perform(*task);
      } catch (...) {
        thrown = std::current_exception();
      }
      lock.lock();
      finish(*task, goes_on);
      if (thrown) {
        stopped_ = true;
        if (!failure_) failure_ = thrown;
      }
      changed_.notify_all();
    }
  }

  const std::function<bool(std::size_t)>& begin_;
  const std::vector<PipelineStage>& stages_;
  const std::function<bool(std::size_t)>& end_;
  const int threads_;
  const std::size_t steps_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::size_t> next_;  // by step: the item that comes next where it is in order
  std::vector<Place> at_;          // by slot
  int busy_ = 0;                   // threads
  bool no_more_ = false, stopped_ = false;
  std::exception_ptr failure_;
};

}  // namespace

void run_pipeline(const std::function<bool(std::size_t slot)>& begin,
                  const std::vector<PipelineStage>& stages, const std::function<bool(std::size_t slot)>& end,
                  std::size_t slots, int threads) {
  Pipeline(begin, stages, end, slots, threads).run();
}

}  // namespace counterflex
