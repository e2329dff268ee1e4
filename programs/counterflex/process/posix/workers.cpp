#include "process/workers.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "counterflex/files/input_error.hpp"
#include "process/signals.hpp"

namespace counterflex::cli {

struct Worker {
  pid_t process;
  int pipe;
  std::size_t task;
  std::string unread{};  ///< the beginning of a line
};

struct Workers::State {
  std::vector<Worker> workers;
};

namespace {

[[noreturn]] void fail_starting() {
  throw InputError(ErrorKind::transient_io, {},
                   fmt::format("cannot start a process: {}", std::strerror(errno)));
}

void send_line(int pipe, std::string_view line) {
  std::string text(line);
  text += '\n';
  for (std::string_view rest = text; !rest.empty();) {
    const ssize_t n = ::write(pipe, rest.data(), rest.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) ::_exit(status_of(SIGPIPE));  // the parent has closed the pipe
    rest.remove_prefix(static_cast<std::size_t>(n));
  }
}

/// Runs in the child. Does not return.
[[noreturn]] void be_worker(pid_t parent, int pipe, const std::function<void(const SendLine&)>& work) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(status_of(SIGKILL));  // the parent has died meanwhile
  unblock_signals();
  try {
    work([pipe](std::string_view line) { send_line(pipe, line); });
    std::fflush(nullptr);
  } catch (...) {  // an exception must not unwind the parent's objects: it would end the other workers
    ::_exit(1);
  }
  ::_exit(0);
}

WorkerEnd end_in_words(int status) {
  if (!WIFSIGNALED(status)) {
    const int number = WEXITSTATUS(status);
    return {fmt::format("ended with status {}", number), number < 128};  // otherwise by a signal
  }
  const int signal = WTERMSIG(status);
  const bool crashed =
      signal == SIGSEGV || signal == SIGABRT || signal == SIGBUS || signal == SIGFPE || signal == SIGILL;
  return {fmt::format("was killed by signal {}{}", signal,
                      signal == SIGKILL ? ", perhaps because memory was short" : ""),
          crashed};
}

WorkerEnd end_of(pid_t process) {
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return end_in_words(status);
}

/// Reads the output of `worker`. Returns false if it has ended.
bool read_from(Worker& worker, std::vector<WorkerEvent>& events) {
  std::array<char, 65536> bytes;
  const ssize_t n = ::read(worker.pipe, bytes.data(), bytes.size());
  if (n < 0) return errno == EINTR;
  worker.unread.append(bytes.data(), static_cast<std::size_t>(n));
  std::size_t begin = 0;
  for (std::size_t end; (end = worker.unread.find('\n', begin)) != std::string::npos; begin = end + 1)
    events.push_back({worker.task, worker.unread.substr(begin, end - begin)});
  worker.unread.erase(0, begin);
  return n > 0;
}

}  // namespace

/// Restores SIGCHLD: if the caller ignores it, `waitpid` gives no status.
Workers::Workers() : state_(new State) {
  std::signal(SIGCHLD, SIG_DFL);
}

Workers::~Workers() {
  end_all(0);
}

std::size_t Workers::running() const {
  return state_->workers.size();
}

void Workers::start(std::size_t task, const std::string&, const std::function<void(const SendLine&)>& work) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail_starting();
  std::fflush(nullptr);  // otherwise the child would write it again
  const pid_t parent = ::getpid();
  const pid_t process = ::fork();
  if (process == 0) {
    ::close(ends[0]);
    for (const Worker& other : state_->workers) ::close(other.pipe);
    be_worker(parent, ends[1], work);
  }
  ::close(ends[1]);
  if (process < 0) {
    const int why = errno;
    ::close(ends[0]);
    errno = why;
    fail_starting();
  }
  state_->workers.push_back({process, ends[0], task});
}

std::vector<WorkerEvent> Workers::wait(const AwaitedSignals* signals, int timeout_ms) {
  std::vector<pollfd> watched;
  for (const Worker& worker : state_->workers) watched.push_back({worker.pipe, POLLIN, 0});
  if (signals != nullptr) watched.push_back({signals->descriptor(), POLLIN, 0});
  std::vector<WorkerEvent> events;
  if (::poll(watched.data(), watched.size(), timeout_ms) <= 0) return events;
  std::vector<Worker> still_running;
  for (std::size_t i = 0; i < state_->workers.size(); ++i) {
    Worker& worker = state_->workers[i];
    if (watched[i].revents == 0 || read_from(worker, events)) {
      still_running.push_back(std::move(worker));
      continue;
    }
    ::close(worker.pipe);
    events.push_back({worker.task, {}, end_of(worker.process)});
  }
  state_->workers = std::move(still_running);
  return events;
}

void Workers::end_all(int patience_ms) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(patience_ms);
  if (patience_ms > 0)
    for (const Worker& worker : state_->workers) ::kill(worker.process, SIGTERM);
  while (!state_->workers.empty() && std::chrono::steady_clock::now() < deadline) wait(nullptr, 10);
  for (const Worker& worker : state_->workers) {
    ::kill(worker.process, SIGKILL);
    ::close(worker.pipe);
    end_of(worker.process);
  }
  state_->workers.clear();
}

bool do_ordered(const std::function<void(const std::string& order, const SendLine&)>&) {
  return false;
}

}  // namespace counterflex::cli
