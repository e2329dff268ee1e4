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

WorkerEnd ending_of(Workers& workers, std::size_t task) {
  while (workers.running() > 0)
    for (const WorkerEvent& event : workers.wait(nullptr, -1))
      if (event.end && event.task == task) return *event.end;
  FAIL("the worker is not there");
  return {};
}

}  // namespace

TEST_CASE("a worker that throws ends alone, with status 1") {
  Workers workers;
  workers.start(0, "", [](const SendLine&) { ::pause(); });
  workers.start(1, "", [](const SendLine&) { throw std::runtime_error("nobody catches this"); });
  const WorkerEnd end = ending_of(workers, 1);
  CHECK(end.text == "ended with status 1");
  CHECK(end.crashed);
  CHECK(workers.running() == 1);
  CHECK(workers.wait(nullptr, 100).empty());  // the other one has not received a signal
}

TEST_CASE("the end of a worker is known for any signals that the caller ignores") {
  std::signal(SIGCHLD, SIG_IGN);
  Workers workers;
  workers.start(0, "", [](const SendLine&) { ::raise(SIGKILL); });
  const WorkerEnd end = ending_of(workers, 0);
  CHECK(end.text == "was killed by signal 9, perhaps because memory was short");
  CHECK_FALSE(end.crashed);
}

TEST_CASE("workers end when the process that started them is killed") {
  int ends[2];
  REQUIRE(::pipe2(ends, O_CLOEXEC) == 0);
  const pid_t parent = ::fork();
  if (parent == 0) {
    Workers workers;
    workers.start(0, "", [&](const SendLine&) {
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
