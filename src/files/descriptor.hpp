#pragma once
/// File descriptors, and what errno says about them.
#include <unistd.h>

#include <string>
#include <string_view>
#include <utility>

#include "counterflex/files/input_error.hpp"

namespace counterflex {

/// Throws `InputError` with the reason in errno: Exit::usage where `path` has to be changed, or what it names
/// (no folder, a name too long, a file system for reading alone), else Exit::transient_io (a disk that fails).
[[noreturn]] void fail_reading(const std::string& path);
[[noreturn]] void fail_writing(const std::string& path);

/// Of `errno` after a call that writes.
Exit exit_of_writing(int error);

/// Bytes that are read or written at once.
inline constexpr std::size_t portion = 1 << 18;

/// Closes on leaving, but for the standard streams; `close` before that to see the error.
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

/// Up to `most` bytes; -1 with errno where they cannot be read.
ssize_t read_some(int fd, char* to, std::size_t most);

/// An empty file without a name, in the folder for temporary files. Its number is negative where there is
/// none.
Descriptor nameless_file();

}  // namespace counterflex
