#pragma once
/// File descriptors, and errors from errno.
#include <unistd.h>

#include <string>
#include <string_view>
#include <utility>

#include "counterflex/files/input_error.hpp"

namespace counterflex {

/// Throws `InputError` with the reason in errno: ErrorKind::usage if `path` or its file must be changed
/// (missing folder, name too long, read-only file system), else ErrorKind::transient_io (disk failure).
[[noreturn]] void fail_reading(const std::string& path);
[[noreturn]] void fail_writing(const std::string& path);

/// Interprets `errno` after a write.
ErrorKind kind_of_writing(int error);

/// Size of a read or a write, in bytes.
inline constexpr std::size_t portion = 1 << 18;

/// Closes its descriptor on destruction, except standard streams. Call `close` before to get errors.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ > STDERR_FILENO) ::close(fd_);
  }
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  int get() const { return fd_; }
  int release() { return std::exchange(fd_, -1); }
  bool close() { return ::close(std::exchange(fd_, -1)) == 0; }

 private:
  int fd_;
};

/// Whether all of `bytes` could be written.
bool write_all(int fd, std::string_view bytes);

/// Reads up to `most` bytes; returns -1 and sets errno on failure.
ssize_t read_some(int fd, char* to, std::size_t most);

}  // namespace counterflex
