#include "counterflex/files/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/evp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "counterflex/files/input_error.hpp"

namespace counterflex {
namespace {

/// Throws what `errno` says about reading or writing `path`.
[[noreturn]] void fail_reading(const std::string& path) {
  const std::string reason = std::strerror(errno);
  if (path == "-") throw InputError(Exit::usage, {}, "cannot read standard input: " + reason);
  throw InputError(Exit::usage, {path, 0, 0}, "cannot read the file: " + reason);
}

[[noreturn]] void fail_writing(const std::string& path) {
  const std::string reason = std::strerror(errno);
  if (path == "-") throw InputError(Exit::transient_io, {}, "cannot write standard output: " + reason);
  throw InputError(Exit::transient_io, {path, 0, 0}, "cannot write the file: " + reason);
}

/// Closes on leaving; `close` before that to see the error.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ > STDERR_FILENO) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }
  bool close() { return ::close(std::exchange(fd_, -1)) == 0; }

 private:
  int fd_;
};

bool write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

/// Devices and pipes have no other name to rename from: they are written directly.
void write_stream(const std::string& path, int fd, std::string_view bytes) {
  if (!write_all(fd, bytes)) fail_writing(path);
}

std::string folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

/// A new file beside `path` that nobody else has.
std::pair<std::string, int> create_beside(const std::string& path) {
  static std::atomic<unsigned> counter{0};
  for (;;) {
    std::string name = fmt::format("{}.{}-{}.tmp", path, ::getpid(), counter++);
    const int fd = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (fd >= 0 || errno != EEXIST) return {std::move(name), fd};
  }
}

bool fill(Descriptor& file, const struct stat* old, std::string_view bytes) {
  if (old != nullptr && ::fchmod(file.get(), old->st_mode & 07777) != 0) return false;
  return write_all(file.get(), bytes) && ::fsync(file.get()) == 0 && file.close();
}

/// Makes the rename survive a power cut where the file system can; where it cannot, the file is there all the
/// same.
void sync_folder(const std::string& folder) {
  const Descriptor descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (descriptor.get() >= 0) (void)::fsync(descriptor.get());
}

void replace(const std::string& path, const std::string& target, const struct stat* old,
             std::string_view bytes) {
  const auto [name, fd] = create_beside(target);
  if (fd < 0) fail_writing(path);
  Descriptor file(fd);
  if (!fill(file, old, bytes) || ::rename(name.c_str(), target.c_str()) != 0) {
    const int error = errno;
    ::unlink(name.c_str());
    errno = error;
    fail_writing(path);
  }
  sync_folder(folder_of(target));
}

}  // namespace

std::string read_file(const std::string& path) {
  const Descriptor file(path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) fail_reading(path);
  std::string bytes;
  char buffer[1 << 16];
  for (;;) {
    const ssize_t n = ::read(file.get(), buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail_reading(path);
    if (n == 0) return bytes;
    bytes.append(buffer, static_cast<std::size_t>(n));
  }
}

void write_file(const std::string& path, std::string_view bytes) {
  if (path == "-") {
    std::fflush(stdout);
    return write_stream(path, STDOUT_FILENO, bytes);
  }
  struct stat old {};
  const bool exists = ::stat(path.c_str(), &old) == 0;
  if (exists && !S_ISREG(old.st_mode) && !S_ISDIR(old.st_mode)) {
    // A pipe that nobody reads would hold the run for ever: it is an error.
    const Descriptor device(::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK));
    if (device.get() < 0 || ::fcntl(device.get(), F_SETFL, O_WRONLY) != 0) fail_writing(path);
    return write_stream(path, device.get(), bytes);
  }
  // Through a symbolic link: the file that it names is replaced, the link stays.
  std::error_code ignored;
  const auto target = exists ? std::filesystem::canonical(path, ignored).string() : path;
  replace(path, target.empty() ? path : target, exists ? &old : nullptr, bytes);
}

std::string sha256(std::string_view bytes) {
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int length = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest, &length, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("SHA-256 is not available");
  std::string text;
  for (unsigned int i = 0; i < length; ++i) text += fmt::format("{:02x}", digest[i]);
  return text;
}

}  // namespace counterflex
