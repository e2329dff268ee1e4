#include "process/signals.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <pthread.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "counterflex/files/file_writer.hpp"
#include "counterflex/files/input_error.hpp"

namespace counterflex::cli {
namespace {

constexpr int ending_signals[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT};

/// Without ignored signals (nohup): a blocked signal is no longer ignored.
sigset_t ending_set() {
  sigset_t set;
  ::sigemptyset(&set);
  for (const int signal : ending_signals) {
    struct sigaction action {};
    if (::sigaction(signal, nullptr, &action) == 0 && action.sa_handler != SIG_IGN) ::sigaddset(&set, signal);
  }
  return set;
}

extern "C" [[noreturn]] void leave_interrupted(int signal) {
  remove_unpublished();
  ::_exit(status_of(signal));
}

}  // namespace

int status_of(int signal) {
  return 128 + signal;
}

void end_on_signals() {
  for (const int signal : ending_signals) {
    struct sigaction old {};
    if (::sigaction(signal, nullptr, &old) != 0 || old.sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = leave_interrupted;
    ::sigemptyset(&action.sa_mask);
    ::sigaction(signal, &action, nullptr);
  }
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

void end_by(int signal) {
  ::raise(signal);
  leave_interrupted(signal);
}

AwaitedSignals::AwaitedSignals() {
  const sigset_t awaited = ending_set();
  ::pthread_sigmask(SIG_BLOCK, &awaited, nullptr);
  descriptor_ = ::signalfd(-1, &awaited, SFD_CLOEXEC | SFD_NONBLOCK);
  if (descriptor_ < 0)
    throw InputError(ErrorKind::transient_io, {},
                     fmt::format("cannot wait for signals: {}", std::strerror(errno)));
}

AwaitedSignals::~AwaitedSignals() {
  ::close(descriptor_);
  unblock_signals();
}

std::optional<int> AwaitedSignals::take(int timeout_ms) const {
  pollfd watched{descriptor_, POLLIN, 0};
  ::poll(&watched, 1, timeout_ms);
  signalfd_siginfo came{};
  if (::read(descriptor_, &came, sizeof came) != sizeof came) return std::nullopt;
  return static_cast<int>(came.ssi_signo);
}

void unblock_signals() {
  const sigset_t ending = ending_set();
  ::pthread_sigmask(SIG_UNBLOCK, &ending, nullptr);
}

struct HeldSignals::State {
  sigset_t set;
};

HeldSignals::HeldSignals() : before_(new State) {
  const sigset_t held = ending_set();
  ::pthread_sigmask(SIG_BLOCK, &held, &before_->set);
}

HeldSignals::~HeldSignals() {
  ::pthread_sigmask(SIG_SETMASK, &before_->set, nullptr);
}

}  // namespace counterflex::cli
