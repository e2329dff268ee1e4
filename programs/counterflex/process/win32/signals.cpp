#include "process/signals.hpp"

#include <windows.h>

#include <atomic>
#include <cstdlib>
#include <mutex>
#include <utility>

#include "counterflex/files/file_writer.hpp"
#include "counterflex/files/input_error.hpp"

namespace counterflex::cli {
namespace {

std::mutex publishing;
std::atomic<int> awaited_event{0};  // a handle, while `AwaitedSignals` exist
std::atomic<int> signal_that_came{0};

/// Handles have 32 bits.
HANDLE handle_of(int number) {
  return reinterpret_cast<HANDLE>(static_cast<std::intptr_t>(number));
}

[[noreturn]] void leave_interrupted(int signal) {
  const std::lock_guard lock(publishing);
  remove_unpublished();
  ::TerminateProcess(::GetCurrentProcess(), static_cast<UINT>(status_of(signal)));
  std::abort();
}

/// The system calls it on a thread of its own: Ctrl-C, Ctrl-Break, a closed window, the end of a session. A
/// process ends when it returns from a closed window.
BOOL WINAPI take_event(DWORD event) {
  const int signal = event == CTRL_C_EVENT ? SIGINT : SIGTERM;
  const bool may_go_on = event == CTRL_C_EVENT || event == CTRL_BREAK_EVENT;
  const int awaited = awaited_event;
  if (awaited == 0 || !may_go_on) leave_interrupted(signal);
  signal_that_came = signal;
  ::SetEvent(handle_of(awaited));
  return TRUE;
}

}  // namespace

int status_of(int signal) {
  return 128 + signal;
}

void end_on_signals() {
  ::SetConsoleCtrlHandler(take_event, TRUE);
}

void end_by(int signal) {
  leave_interrupted(signal);
}

AwaitedSignals::AwaitedSignals()
    : descriptor_(
          static_cast<int>(reinterpret_cast<std::intptr_t>(::CreateEventW(nullptr, FALSE, FALSE, nullptr)))) {
  if (descriptor_ == 0) throw InputError(ErrorKind::transient_io, {}, "cannot wait for signals");
  awaited_event = descriptor_;
}

AwaitedSignals::~AwaitedSignals() {
  awaited_event = 0;
  ::CloseHandle(handle_of(descriptor_));
}

std::optional<int> AwaitedSignals::take(int timeout_ms) const {
  if (signal_that_came == 0)
    ::WaitForSingleObject(handle_of(descriptor_), timeout_ms < 0 ? INFINITE : static_cast<DWORD>(timeout_ms));
  const int signal = signal_that_came.exchange(0);
  if (signal == 0) return std::nullopt;
  return signal;
}

struct HeldSignals::State {
  std::lock_guard<std::mutex> lock{publishing};
};

HeldSignals::HeldSignals() : before_(new State) {}
HeldSignals::~HeldSignals() = default;

}  // namespace counterflex::cli
