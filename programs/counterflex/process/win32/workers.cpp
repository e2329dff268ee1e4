#include "process/workers.hpp"

#include <fmt/format.h>
#include <windows.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <thread>
#include <utility>

#include "counterflex/files/input_error.hpp"

namespace counterflex::cli {
namespace {

constexpr wchar_t order_variable[] = L"CFX_ORDER";

/// Paths of the command line are relative to it.
const std::filesystem::path first_folder = std::filesystem::current_path();

[[noreturn]] void fail_starting() {
  throw InputError(ErrorKind::transient_io, {},
                   fmt::format("cannot start a process: error {} of Windows", ::GetLastError()));
}

HANDLE handle_of(const AwaitedSignals& signals) {
  return reinterpret_cast<HANDLE>(static_cast<std::intptr_t>(signals.descriptor()));
}

/// Exceptions of the processor and of the system have such numbers.
WorkerEnd end_in_words(DWORD status) {
  constexpr DWORD exceptions_begin = 0xC0000000;
  if (status >= exceptions_begin) return {fmt::format("was ended by exception {:#X}", status), true};
  return {fmt::format("ended with status {}", status), status < 128};  // otherwise by Ctrl-C
}

/// The value of the variable, which `order` has while this exists.
class OrderInEnvironment {
 public:
  explicit OrderInEnvironment(const std::string& order) {
    ::SetEnvironmentVariableW(order_variable, std::filesystem::path(order).wstring().c_str());
  }
  ~OrderInEnvironment() { ::SetEnvironmentVariableW(order_variable, nullptr); }
  OrderInEnvironment(const OrderInEnvironment&) = delete;
  OrderInEnvironment& operator=(const OrderInEnvironment&) = delete;
};

}  // namespace

struct Worker {
  HANDLE process, pipe;
  DWORD number;  ///< of the process
  std::size_t task;
  std::thread reader{};
};

struct Workers::State {
  HANDLE job = ::CreateJobObjectW(nullptr, nullptr);  ///< its processes end with this one
  HANDLE news = ::CreateEventW(nullptr, FALSE, FALSE, nullptr);
  std::vector<Worker> workers{};
  std::mutex mutex{};
  std::vector<WorkerEvent> events{};  ///< that `wait` has not returned

  void add(WorkerEvent event) {
    const std::lock_guard lock(mutex);
    events.push_back(std::move(event));
    ::SetEvent(news);
  }

  /// On a thread for each worker: pipes of Windows cannot be waited for together.
  void read(HANDLE process, HANDLE pipe, std::size_t task) {
    std::string unread;
    std::array<char, 65536> bytes;
    for (DWORD count = 0;
         ::ReadFile(pipe, bytes.data(), static_cast<DWORD>(bytes.size()), &count, nullptr) != 0;) {
      unread.append(bytes.data(), count);
      std::size_t begin = 0;
      for (std::size_t end; (end = unread.find('\n', begin)) != std::string::npos; begin = end + 1)
        add({task, unread.substr(begin, end - begin)});
      unread.erase(0, begin);
    }
    ::WaitForSingleObject(process, INFINITE);
    DWORD status = 0;
    ::GetExitCodeProcess(process, &status);
    add({task, {}, end_in_words(status)});
  }

  void remove(std::size_t task) {
    const auto ended =
        std::find_if(workers.begin(), workers.end(), [&](const Worker& w) { return w.task == task; });
    ended->reader.join();
    ::CloseHandle(ended->process);
    ::CloseHandle(ended->pipe);
    workers.erase(ended);
  }
};

Workers::Workers() : state_(new State) {
  JOBOBJECT_EXTENDED_LIMIT_INFORMATION limits{};
  limits.BasicLimitInformation.LimitFlags = JOB_OBJECT_LIMIT_KILL_ON_JOB_CLOSE;
  if (::SetInformationJobObject(state_->job, JobObjectExtendedLimitInformation, &limits, sizeof limits) == 0)
    fail_starting();
}

Workers::~Workers() {
  end_all(0);
  ::CloseHandle(state_->news);
  ::CloseHandle(state_->job);
}

std::size_t Workers::running() const {
  return state_->workers.size();
}

/// The process is stopped until it belongs to the job. Its group is its own, so that Ctrl-C ends this process
/// alone, which then ends the others.
void Workers::start(std::size_t task, const std::string& order, const std::function<void(const SendLine&)>&) {
  HANDLE to_read = nullptr, to_write = nullptr;
  SECURITY_ATTRIBUTES inherited{sizeof inherited, nullptr, TRUE};
  if (::CreatePipe(&to_read, &to_write, &inherited, 0) == 0) fail_starting();
  ::SetHandleInformation(to_read, HANDLE_FLAG_INHERIT, 0);
  STARTUPINFOW streams{};
  streams.cb = sizeof streams;
  streams.dwFlags = STARTF_USESTDHANDLES;
  streams.hStdOutput = to_write;
  streams.hStdError = ::GetStdHandle(STD_ERROR_HANDLE);
  ::SetHandleInformation(streams.hStdError, HANDLE_FLAG_INHERIT, HANDLE_FLAG_INHERIT);
  PROCESS_INFORMATION started{};
  std::wstring command_line = ::GetCommandLineW();
  std::array<wchar_t, 32768> program{};
  ::GetModuleFileNameW(nullptr, program.data(), static_cast<DWORD>(program.size()));
  const OrderInEnvironment variable(order);
  const BOOL made = ::CreateProcessW(program.data(), command_line.data(), nullptr, nullptr, TRUE,
                                     CREATE_SUSPENDED | CREATE_NEW_PROCESS_GROUP, nullptr,
                                     first_folder.wstring().c_str(), &streams, &started);
  ::CloseHandle(to_write);
  if (made == 0) {
    ::CloseHandle(to_read);
    fail_starting();
  }
  ::AssignProcessToJobObject(state_->job, started.hProcess);
  ::ResumeThread(started.hThread);
  ::CloseHandle(started.hThread);
  Worker worker{started.hProcess, to_read, started.dwProcessId, task};
  worker.reader = std::thread(&State::read, state_.get(), worker.process, worker.pipe, task);
  state_->workers.push_back(std::move(worker));
}

std::vector<WorkerEvent> Workers::wait(const AwaitedSignals* signals, int timeout_ms) {
  const std::array waited{state_->news, signals != nullptr ? handle_of(*signals) : nullptr};
  const DWORD end = ::WaitForMultipleObjects(signals != nullptr ? 2 : 1, waited.data(), FALSE,
                                             timeout_ms < 0 ? INFINITE : static_cast<DWORD>(timeout_ms));
  if (end == WAIT_OBJECT_0 + 1) ::SetEvent(waited[1]);  // for `take`
  std::vector<WorkerEvent> events;
  {
    const std::lock_guard lock(state_->mutex);
    events.swap(state_->events);
  }
  for (const WorkerEvent& event : events)
    if (event.end) state_->remove(event.task);
  return events;
}

void Workers::end_all(int patience_ms) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(patience_ms);
  if (patience_ms > 0)
    for (const Worker& worker : state_->workers) ::GenerateConsoleCtrlEvent(CTRL_BREAK_EVENT, worker.number);
  while (!state_->workers.empty() && std::chrono::steady_clock::now() < deadline) wait(nullptr, 10);
  for (const Worker& worker : state_->workers)
    ::TerminateProcess(worker.process, static_cast<UINT>(status_of(SIGTERM)));
  while (!state_->workers.empty()) wait(nullptr, -1);
}

bool do_ordered(const std::function<void(const std::string& order, const SendLine&)>& work) {
  std::array<wchar_t, 32768> order{};
  if (::GetEnvironmentVariableW(order_variable, order.data(), static_cast<DWORD>(order.size())) == 0)
    return false;
  work(std::filesystem::path(order.data()).generic_string(), [](std::string_view line) {
    std::fwrite(line.data(), 1, line.size(), stdout);
    std::fputc('\n', stdout);
    std::fflush(stdout);
  });
  return true;
}

}  // namespace counterflex::cli
