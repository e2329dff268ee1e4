#pragma once
/// What is too much for memory, kept in a temporary file.
#include <cstddef>
#include <string_view>
#include <utility>

namespace counterflex {

/// Bytes that are written one behind the other and read anywhere, in a nameless file among the temporary
/// ones. It holds nothing, not even a file, before the first byte. All members throw `InputError`
/// (Exit::transient_io) where the file cannot be written or read.
class Spool {
 public:
  Spool() = default;
  ~Spool();
  Spool(Spool&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Spool& operator=(Spool&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }

  void append(std::string_view bytes);

  /// `count` bytes that were appended, from `offset` on.
  void read(std::size_t offset, char* to, std::size_t count) const;

 private:
  int fd_ = -1;
};

}  // namespace counterflex
