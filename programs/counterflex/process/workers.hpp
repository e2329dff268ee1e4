#pragma once
/// Runs tasks in separate processes: a crash affects only its own task.
#include <sys/types.h>

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace counterflex::cli {

/// Sends one line, without its end, from a worker to its parent.
using SendLine = std::function<void(std::string_view line)>;

/// A line of a worker, or its end.
struct WorkerEvent {
  std::size_t task = 0;
  std::string line{};
  bool ended = false;
  int status = 0;  ///< of `waitpid`, for a worker that ended
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

  /// Forks a process for `work`, which ends when `work` returns, without destroying the parent's objects.
  /// Signals have their original handlers there. If `work` throws, the process ends with status 1.
  void start(std::size_t task, const std::function<void(const SendLine&)>& work);

  std::size_t running() const { return workers_.size(); }

  /// Waits for a line or the end of a worker, for `other` (a descriptor, or -1) to become readable, or for
  /// the timeout. Returns the events since the last call, in order for each worker.
  std::vector<WorkerEvent> wait(int other, int timeout_ms);

  /// Sends SIGTERM to all, and kills those that have not ended after `patience_ms`.
  void end_all(int patience_ms);

 private:
  struct Worker {
    pid_t process;
    int pipe;
    std::size_t task;
    std::string unread{};  ///< the beginning of a line
  };

  bool read_from(Worker& worker, std::vector<WorkerEvent>& events);

  std::vector<Worker> workers_;
};

/// A status of `waitpid` in words: "ended with status 3", "was killed by signal 9".
std::string ending_text(int status);

}  // namespace counterflex::cli
