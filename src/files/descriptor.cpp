#include "files/descriptor.hpp"

#include <algorithm>
#include <array>
#include <cerrno>

#include "counterflex/files/input_error.hpp"
#include "counterflex/files/system.hpp"

namespace counterflex {

namespace {

/// Whether the error is permanent: it stays until the path, the file or its permissions change.
bool is_of_path(int error) {
  constexpr std::array lasting{ENOENT,  EACCES, EPERM,        EISDIR,
                               ENOTDIR, ELOOP,  ENAMETOOLONG, EBADF};  // EBADF: standard input is closed
  return std::find(lasting.begin(), lasting.end(), error) != lasting.end();
}

/// Of one call: Windows takes fewer bytes than `std::size_t` can count.
unsigned count_of(std::size_t bytes) {
  constexpr std::size_t most = 1 << 30;
  return static_cast<unsigned>(std::min(bytes, most));
}

}  // namespace

void fail_reading(const std::string& path) {
  const std::string reason = system::reason_of(errno);
  const ErrorKind kind = is_of_path(errno) ? ErrorKind::usage : ErrorKind::transient_io;
  if (path == "-") throw InputError(kind, {}, "cannot read standard input: " + reason);
  throw InputError(kind, {path, 0, 0}, "cannot read the file: " + reason);
}

ErrorKind kind_of_writing(int error) {
  const bool lasting =
      is_of_path(error) || error == EROFS || error == EEXIST || error == ENXIO;  // ENXIO: no reader
  return lasting ? ErrorKind::usage : ErrorKind::transient_io;
}

void fail_writing(const std::string& path) {
  const std::string reason = system::reason_of(errno);
  const ErrorKind kind = kind_of_writing(errno);
  if (path == "-") throw InputError(kind, {}, "cannot write standard output: " + reason);
  throw InputError(kind, {path, 0, 0}, "cannot write the file: " + reason);
}

bool write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), count_of(bytes.size()));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

ssize_t read_some(int fd, char* to, std::size_t most) {
  for (;;) {
    const ssize_t n = ::read(fd, to, count_of(most));
    if (n >= 0 || errno != EINTR) return n;
  }
}

}  // namespace counterflex
