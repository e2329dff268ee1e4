#include "counterflex/batch/folder_lock.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "counterflex/files/files.hpp"
#include "counterflex/files/system.hpp"

namespace counterflex {
namespace {

constexpr std::size_t longest_text = 1000;

// A read-only file system is a lasting error.
[[noreturn]] void fail_locking(const std::string& folder, int error, const std::string& reason) {
  throw InputError(error == EROFS ? ErrorKind::usage : ErrorKind::transient_io, {folder},
                   "cannot lock the folder: " + reason);
}

bool file_system_has_no_locks(int error) {
  return error == ENOLCK || error == ENOTSUP || error == EOPNOTSUPP || error == ENOSYS;
}

std::string one_line(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }, ' ');
  return text.substr(0, longest_text);
}

std::string text_of_holder(std::string_view command) {
  return one_line(fmt::format("{} {} {}", system::host_name(), ::getpid(), command)) + '\n';
}

/// "process PID on HOST (COMMAND)", from the text of the lock at `fd`.
std::string holder(int fd) {
  std::array<char, longest_text + 1> bytes{};
  const std::ptrdiff_t n = system::read_at(fd, bytes.data(), bytes.size(), 0);
  const std::string text(bytes.data(), static_cast<std::size_t>(std::max<std::ptrdiff_t>(n, 0)));
  const std::size_t host = text.find(' '), pid = text.find(' ', host + 1);
  if (host == std::string::npos || pid == std::string::npos)
    return "processes without a name, such as shards";
  return one_line(fmt::format("process {} on {} ({})", text.substr(host + 1, pid - host - 1),
                              text.substr(0, host), text.substr(pid + 1, text.find('\n') - pid - 1)));
}

}  // namespace

FolderLock::FolderLock(const std::string& folder, LockKind kind, std::string_view command) {
  const std::string state = folder + "/.counterflex", path = state + "/lock";
  make_folder(state);
  fd_ = system::open_or_make(path);
  if (fd_ < 0) fail_locking(folder, errno, fmt::format("{}: {}", path, system::reason_of(errno)));
  const bool alone = kind == LockKind::exclusive;
  if (system::lock(fd_, alone)) {
    system::replace_text(fd_,
                         alone ? text_of_holder(command) : "");  // on a full disk the lock works without it
    if (alone) owner_ = ::getpid();
    return;
  }
  const int error = errno;
  if (file_system_has_no_locks(error)) why_not_ = system::reason_of(error);
  const std::string other = error == EWOULDBLOCK ? holder(fd_) : "";
  if (why_not_.empty()) ::close(std::exchange(fd_, -1));
  if (error == EWOULDBLOCK)
    throw InputError(ErrorKind::transient_io, {folder},
                     fmt::format("another run is active in this folder: {}", other));
  if (why_not_.empty()) fail_locking(folder, error, system::reason_of(error));
}

FolderLock::~FolderLock() {
  if (fd_ < 0) return;
  if (owner_ == ::getpid()) system::replace_text(fd_, "");
  ::close(fd_);
}

FolderLock::FolderLock(FolderLock&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)), owner_(other.owner_), why_not_(std::move(other.why_not_)) {}

}  // namespace counterflex
