#include "process/signals.hpp"

#include <windows.h>

#include <mutex>

#include "counterflex/files/file_writer.hpp"

namespace counterflex::cli {
namespace {

std::mutex held;

/// The system calls it on a thread of its own: Ctrl-C, Ctrl-Break, a closed window, the end of a session.
BOOL WINAPI leave_interrupted(DWORD event) {
  const std::lock_guard lock(held);
  remove_unpublished();
  const bool by_key = event == CTRL_C_EVENT || event == CTRL_BREAK_EVENT;
  ::TerminateProcess(::GetCurrentProcess(), static_cast<UINT>(status_of(by_key ? SIGINT : SIGTERM)));
  return TRUE;
}

}  // namespace

int status_of(int signal) {
  return 128 + signal;
}

void end_on_signals() {
  ::SetConsoleCtrlHandler(leave_interrupted, TRUE);
}

struct HeldSignals::State {
  std::lock_guard<std::mutex> lock{held};
};

HeldSignals::HeldSignals() : before_(new State) {}
HeldSignals::~HeldSignals() = default;

}  // namespace counterflex::cli
