#pragma once
/// Whole files in, whole files out.
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace counterflex {

/// The bytes of a file; "-" is standard input. Throws as `FileReader` where it cannot be read.
std::string read_file(const std::string& path);

/// Writes `bytes` under `path` or not at all: to a temporary name in the same folder, flushed, then renamed.
/// "-" is standard output. Throws `InputError` (ErrorKind::transient_io) naming the path, and leaves no
/// temporary file.
void write_file(const std::string& path, std::string_view bytes);

/// SHA-256 of `bytes`, 64 lower-case hexadecimal digits.
std::string sha256(std::string_view bytes);

/// RFC 4648, with padding.
std::string base64(std::string_view bytes);

/// "sha256-" and the digest in base64: how a page's security policy names what it allows.
std::string integrity(std::string_view bytes);

// Folders, and names in them that survive a power cut.

/// That of the file `path`; "." for a name alone.
std::string folder_of(const std::string& path);

/// Makes `path` and what is missing above it. Throws `InputError` (ErrorKind::transient_io) naming the folder
/// that cannot be made.
void make_folder(const std::string& path);

/// Brings the names of files in `folder` to the disk. Where a file system or the folder's rights do not allow
/// that, the files are there all the same. Throws `InputError` (ErrorKind::transient_io) where the disk
/// fails.
void sync_folder(const std::string& folder);

// SHA-256 of bytes that come in portions.

class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;

  void add(std::string_view bytes);

  /// Of all that was added, 64 lower-case hexadecimal digits; nothing can be added any more.
  std::string digits();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// What is too much for memory, kept in a temporary file.

/// Bytes that are written one behind the other and read anywhere, in a nameless file among the temporary
/// ones. It holds nothing, not even a file, before the first byte. All members throw `InputError`
/// (ErrorKind::transient_io) where the file cannot be written or read.
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
