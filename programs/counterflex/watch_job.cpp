#include "watch_job.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "commands.hpp"
#include "guarded.hpp"
#include "outputs.hpp"

namespace counterflex::cli {
namespace {

std::string in_folder(const std::string& folder, const std::filesystem::path& name) {
  return (std::filesystem::path(folder) / name).string();
}

[[noreturn]] void work_and_end(const Options& job, Console& console, const sigset_t& signals, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(static_cast<int>(Exit::interrupted));  // it was too late to ask
  ::sigprocmask(SIG_SETMASK, &signals, nullptr);
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  if (nowhere >= 0) {
    ::dup2(nowhere, STDIN_FILENO);
    ::dup2(nowhere, STDOUT_FILENO);
  }
  const Exit exit = guarded(console, [&] { return run_compensate(job, console); });
  std::fflush(nullptr);
  ::_exit(static_cast<int>(exit));
}

}  // namespace

Options watch_job(const Options& watch, const std::string& program) {
  const std::filesystem::path path(program);
  Options job = watch;
  job.command = Command::compensate;
  job.program = program;
  job.json = false;  // of the watch: a line for each program
  if (watch.output) job.output = in_folder(*watch.output, path.filename());
  if (watch.report) job.report = in_folder(*watch.report, path.stem());
  if (watch.plot) job.plot = in_folder(*watch.plot, path.stem().string() + ".svg");
  return job;
}

std::string watch_output(const Options& job) {
  return job.output.value_or(default_output(job.program));
}

WatchChild::WatchChild(Options job, Console& console, const sigset_t& signals) : job_(std::move(job)) {
  std::fflush(nullptr);  // what is not written yet would be written twice
  const pid_t parent = ::getpid();
  pid_ = ::fork();
  if (pid_ == 0) work_and_end(job_, console, signals, parent);
  if (pid_ < 0)
    throw InputError(Exit::transient_io, {job_.program},
                     fmt::format("no process can be started for it: {}", std::strerror(errno)));
}

bool WatchChild::has_ended(Console& console, Exit& exit) {
  int status = 0;
  if (::waitpid(pid_, &status, WNOHANG) != pid_) return false;
  exit = WIFEXITED(status) ? static_cast<Exit>(WEXITSTATUS(status)) : Exit::internal;
  if (WIFSIGNALED(status))
    console.error(fmt::format("{}: error: its run was ended by signal {} ({})", job_.program,
                              WTERMSIG(status), ::strsignal(WTERMSIG(status))));
  return true;
}

void WatchChild::interrupt() {
  ::kill(pid_, SIGTERM);
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) continue;
}

}  // namespace counterflex::cli
