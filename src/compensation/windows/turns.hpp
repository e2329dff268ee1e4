#pragma once
/// Items that several threads take through steps at once. Some steps take the items in their order.
#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <vector>

namespace counterflex {

class Turns {
 public:
  /// `steps`: of those that take items in order.
  Turns(int threads, std::size_t steps) : threads_(threads), next_(steps) {}

  /// Calls `work` on `workers` threads, one of which is the calling one. Each takes one item after another
  /// through all of its steps. Throws the first thing that a step in order has thrown.
  void run(std::size_t workers, const std::function<void()>& work);

  /// The number of the next item.
  std::size_t take() { return items_++; }

  /// Calls `work` when all items before have had this step. False if the run was stopped before that, or by
  /// `work`.
  bool in_turn(std::size_t step, std::size_t item, const std::function<void()>& work);

  /// No step in order begins from now on.
  void stop();

  /// How many threads a step out of order may use now.
  int free_threads();

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

}  // namespace counterflex
