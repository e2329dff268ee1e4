#include "signals.hpp"

#include <pthread.h>
#include <unistd.h>

#include "counterflex/files/file_writer.hpp"

namespace counterflex::cli {
namespace {

constexpr int ending[] = {SIGINT, SIGTERM, SIGHUP};

extern "C" void leave_interrupted(int signal) {
  remove_unpublished();
  ::_exit(status_of(signal));
}

}  // namespace

int status_of(int signal) {
  return 128 + signal;
}

void end_on_signals() {
  for (const int signal : ending) {
    struct sigaction old {};
    if (::sigaction(signal, nullptr, &old) != 0 || old.sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = leave_interrupted;
    ::sigemptyset(&action.sa_mask);
    ::sigaction(signal, &action, nullptr);
  }
  std::signal(SIGPIPE, SIG_IGN);
}

HeldSignals::HeldSignals() {
  sigset_t held;
  ::sigemptyset(&held);
  for (const int signal : ending) ::sigaddset(&held, signal);
  ::pthread_sigmask(SIG_BLOCK, &held, &before_);
}

HeldSignals::~HeldSignals() {
  ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

}  // namespace counterflex::cli
