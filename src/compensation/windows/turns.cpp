#include "compensation/windows/turns.hpp"

#include <algorithm>
#include <thread>

namespace counterflex {

void Turns::run(std::size_t workers, const std::function<void()>& work) {
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

bool Turns::in_turn(std::size_t step, std::size_t item, const std::function<void()>& work) {
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

void Turns::stop() {
  const std::lock_guard lock(mutex_);
  stopped_ = true;
  changed_.notify_all();
}

int Turns::free_threads() {
  const std::lock_guard lock(mutex_);
  return std::max(1, threads_ / std::max(1, active_));
}

}  // namespace counterflex
