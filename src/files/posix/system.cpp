#include "counterflex/files/system.hpp"

#include <fcntl.h>
#include <fnmatch.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "files/descriptor.hpp"

namespace counterflex::system {
namespace {

/// For `mkostemp` and `mkdtemp`, which replace the last letters.
std::string temporary_pattern() {
  std::error_code ignored;
  return (std::filesystem::temp_directory_path(ignored) / "counterflex-XXXXXX").string();
}

std::int64_t nanoseconds_of(const timespec& time) {
  constexpr std::int64_t per_second = 1'000'000'000;
  return std::int64_t{time.tv_sec} * per_second + time.tv_nsec;
}

FileKind kind_of(mode_t mode) {
  if (S_ISREG(mode)) return FileKind::file;
  return S_ISDIR(mode) ? FileKind::folder : FileKind::stream;
}

FileFacts facts(const struct stat& found) {
  constexpr mode_t rights = 07777;
  return {kind_of(found.st_mode),
          found.st_dev,
          found.st_ino,
          static_cast<std::uint64_t>(found.st_size),
          nanoseconds_of(found.st_mtim),
          nanoseconds_of(found.st_ctim),
          found.st_mode & rights};
}

}  // namespace

std::optional<FileFacts> facts_of(int descriptor) {
  struct stat found {};
  if (::fstat(descriptor, &found) != 0) return std::nullopt;
  return facts(found);
}

std::optional<FileFacts> facts_of(const std::string& path) {
  struct stat found {};
  if (::stat(path.c_str(), &found) != 0) return std::nullopt;
  return facts(found);
}

int open_to_read(const std::string& path) {
  return ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
}

int open_stream(const std::string& path) {
  Descriptor device(::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK));
  if (device.get() < 0 || ::fcntl(device.get(), F_SETFL, O_WRONLY) != 0) return -1;
  return device.release();
}

int open_or_make(const std::string& path) {
  return ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
}

/// A lock shows that its writer is running. What removes abandoned files may have it first, and removes the
/// file.
int make_file(const std::string& path) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644));
  if (file.get() < 0) return -1;
  const bool taken = ::flock(file.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  struct stat found {};
  if (!taken && (::fstat(file.get(), &found) != 0 || found.st_nlink > 0)) return file.release();
  file.close();
  errno = EEXIST;
  return -1;
}

bool remove_abandoned(const std::string& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  return file.get() >= 0 && ::flock(file.get(), LOCK_EX | LOCK_NB) == 0 && ::unlink(path.c_str()) == 0;
}

int make_nameless_file() {
  std::string name = temporary_pattern();
  const int fd = ::mkostemp(name.data(), O_CLOEXEC);
  if (fd >= 0) ::unlink(name.c_str());
  return fd;
}

std::optional<std::string> make_temporary_folder() {
  std::string name = temporary_pattern();
  if (::mkdtemp(name.data()) == nullptr) return std::nullopt;
  return name;
}

std::ptrdiff_t read_at(int descriptor, char* to, std::size_t most, std::size_t offset) {
  for (;;) {
    const ssize_t n = ::pread(descriptor, to, most, static_cast<off_t>(offset));
    if (n >= 0 || errno != EINTR) return n;
  }
}

bool append(int descriptor, std::string_view bytes) {
  return write_all(descriptor, bytes);
}

bool replace_text(int descriptor, std::string_view text) {
  if (::ftruncate(descriptor, 0) != 0) return false;
  return ::pwrite(descriptor, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size());
}

bool set_mode(int descriptor, unsigned mode) {
  return ::fchmod(descriptor, mode) == 0;
}

bool flush_to_disk(int descriptor) {
  return ::fsync(descriptor) == 0;
}

bool make_folder(const std::string& path) {
  return ::mkdir(path.c_str(), 0777) == 0;
}

bool flush_names_to_disk(const std::string& folder) {
  const Descriptor descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  return descriptor.get() >= 0 && ::fsync(descriptor.get()) == 0;
}

bool rename_file(const std::string& from, const std::string& to) {
  return ::rename(from.c_str(), to.c_str()) == 0;
}

void remove_file(const char* path) noexcept {
  ::unlink(path);
}

bool lock(int descriptor, bool exclusive) {
  return ::flock(descriptor, (exclusive ? LOCK_EX : LOCK_SH) | LOCK_NB) == 0;
}

bool matches(const std::string& pattern, const std::string& name) {
  return ::fnmatch(pattern.c_str(), name.c_str(), FNM_PERIOD) == 0;
}

const char list_separator = ':';

std::string reason_of(int error) {
  return std::strerror(error);
}

std::string host_name() {
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '?';
  return host.data();
}

}  // namespace counterflex::system
