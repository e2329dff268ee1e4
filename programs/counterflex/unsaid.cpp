#include "unsaid.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>

namespace counterflex::cli {
namespace {

constexpr std::size_t most_kept = 1 << 20;
constexpr std::size_t taken_at_once = 512;  // by a pipe that takes anything; a terminal is asked more often

/// Flags of a stream hold for all who have it, the caller's shell too; those of a stream that is opened again
/// do not. A file would be written from its beginning then, but it never makes anybody wait.
int opened_without_waiting(int descriptor) {
  struct stat facts {};
  if (::fstat(descriptor, &facts) != 0 || !(S_ISCHR(facts.st_mode) || S_ISFIFO(facts.st_mode))) return -1;
  const std::string name = fmt::format("/proc/self/fd/{}", descriptor);
  return ::open(name.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
}

}  // namespace

Unsaid::Unsaid(int descriptor) : stream_(descriptor), own_(opened_without_waiting(descriptor)) {}

Unsaid::~Unsaid() {
  if (own_ >= 0) ::close(own_);
}

bool Unsaid::takes_some(int timeout_ms) const {
  pollfd watched{own_ >= 0 ? own_ : stream_, POLLOUT, 0};
  return ::poll(&watched, 1, timeout_ms) > 0;
}

void Unsaid::add(std::string_view text) {
  if (kept_.size() + text.size() <= most_kept) kept_ += text;
  send(0);
}

bool Unsaid::send(int patience_ms) {
  using Clock = std::chrono::steady_clock;
  const auto last = Clock::now() + std::chrono::milliseconds(patience_ms);
  while (!kept_.empty()) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(last - Clock::now()).count();
    if (!takes_some(static_cast<int>(std::max<long>(0, left)))) return false;
    const ssize_t n =
        ::write(own_ >= 0 ? own_ : stream_, kept_.data(), std::min(taken_at_once, kept_.size()));
    if (n >= 0)
      kept_.erase(0, static_cast<std::size_t>(n));
    else if (errno == EAGAIN && left > 0)
      ::poll(nullptr, 0, 10);  // somebody else was faster
    else if (errno == EAGAIN)
      return false;
    else if (errno != EINTR)
      kept_.clear();  // nobody is there to hear it
  }
  return true;
}

bool Unsaid::is_clear() {
  return send(0) && takes_some(0);
}

}  // namespace counterflex::cli
