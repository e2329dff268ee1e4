#pragma once
/// Tasks in processes of their own: one that crashes takes nothing else with it.
#include <sys/types.h>

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace counterflex::cli {

/// How a worker tells its parent something: one line, without its end.
using SendLine = std::function<void(std::string_view line)>;

/// What a worker has said, or that it has ended.
struct WorkerEvent {
  std::size_t task = 0;
  std::string line{};
  bool ended = false;
  int status = 0;  ///< as `waitpid` gives it; of one that ended
};

/// The workers of a process that has no other threads. They die with it, however it ends: none of them
/// writes anything that nobody waits for. All members throw `InputError` (Exit::transient_io) where the
/// system has no more processes or pipes.
class Workers {
 public:
  Workers();
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Forks a process for `work`; it ends when that returns, without cleaning up what is its parent's. There
  /// signals do what they did when this program began. A `work` that throws ends it with status 1.
  void start(std::size_t task, const std::function<void(const SendLine&)>& work);

  std::size_t running() const { return workers_.size(); }

  /// Waits until a worker has said something or ended, `other` (a descriptor, or -1) can be read, or the
  /// time is over; what has been said since, in the order of each worker.
  std::vector<WorkerEvent> wait(int other, int timeout_ms);

  /// Asks all to end, and kills those that have not after `patience_ms`.
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

/// How a process ended that `waitpid` says has, in words: "ended with status 3", "was killed by signal 9".
std::string ending_text(int status);

}  // namespace counterflex::cli
