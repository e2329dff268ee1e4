#include "process/workers.hpp"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <stdexcept>

using namespace counterflex::cli;

namespace {

/// How the worker of `task` ended, as `waitpid` gives it.
int ending_of(Workers& workers, std::size_t task) {
  while (workers.running() > 0)
    for (const WorkerEvent& event : workers.wait(-1, -1))
      if (event.ended && event.task == task) return event.status;
  FAIL("the worker is not there");
  return 0;
}

}  // namespace

TEST_CASE("a worker that throws ends alone, with status 1") {
  Workers workers;
  workers.start(0, [](const SendLine&) { ::pause(); });
  workers.start(1, [](const SendLine&) { throw std::runtime_error("nobody catches this"); });
  const int status = ending_of(workers, 1);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 1);
  CHECK(workers.running() == 1);
  CHECK(workers.wait(-1, 100).empty());  // the other one has not received a signal
}

TEST_CASE("the end of a worker is known for any signals that the caller ignores") {
  std::signal(SIGCHLD, SIG_IGN);
  Workers workers;
  workers.start(0, [](const SendLine&) { ::raise(SIGKILL); });
  CHECK(ending_text(ending_of(workers, 0)) == "was killed by signal 9");
}

TEST_CASE("workers end when the process that started them is killed") {
  int ends[2];
  REQUIRE(::pipe2(ends, O_CLOEXEC) == 0);
  const pid_t parent = ::fork();
  if (parent == 0) {
    Workers workers;
    workers.start(0, [&](const SendLine&) {
      if (::write(ends[1], "b", 1) == 1)
        for (;;) ::pause();
    });
    for (;;) ::pause();
  }
  ::close(ends[1]);
  char byte = 0;
  CHECK(::read(ends[0], &byte, 1) == 1);
  ::kill(parent, SIGKILL);
  CHECK(::waitpid(parent, nullptr, 0) == parent);
  pollfd end{ends[0], POLLIN, 0};
  CHECK(::poll(&end, 1, 10'000) == 1);  // the end of the pipe, when the worker no longer holds it
  ::close(ends[0]);
}
