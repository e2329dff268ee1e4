#pragma once
/// Runs tasks in separate processes: a crash affects only its own task. Each system has its implementation:
/// Linux forks, Windows starts the program again.
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "process/signals.hpp"

namespace counterflex::cli {

/// Sends one line, without its end, from a worker to its parent.
using SendLine = std::function<void(std::string_view line)>;

/// How a process ended.
struct WorkerEnd {
  std::string text{};    ///< "ended with status 3", "was killed by signal 9"
  bool crashed = false;  ///< by an error of its own: another run would crash, too
};

/// A line of a worker, or its end.
struct WorkerEvent {
  std::size_t task = 0;
  std::string line{};
  std::optional<WorkerEnd> end{};
};

/// The workers of a process without other threads. They are killed when it ends for any reason, so that they
/// do not continue to write. All members throw `InputError` (ErrorKind::transient_io) if the system has no
/// more processes or pipes.
class Workers {
 public:
  Workers();
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Linux: forks a process for `work`, which ends when `work` returns, without destroying the parent's
  /// objects. Signals have their original handlers there. If `work` throws, the process ends with status 1.
  /// Windows: starts the command line of this process again, in the folder in which this one was started. The
  /// new process calls `do_ordered`, which gets `order`.
  void start(std::size_t task, const std::string& order, const std::function<void(const SendLine&)>& work);

  std::size_t running() const;

  /// Waits for a line or the end of a worker, for a signal, or for the timeout (-1: without limit). Returns
  /// the events since the last call, in order for each worker.
  std::vector<WorkerEvent> wait(const AwaitedSignals* signals, int timeout_ms);

  /// Asks all to end, and kills those that have not ended after `patience_ms`.
  void end_all(int patience_ms);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// In a process that `Workers` have started with an order: does it, and returns true. Linux: returns false.
bool do_ordered(const std::function<void(const std::string& order, const SendLine&)>& work);

}  // namespace counterflex::cli
