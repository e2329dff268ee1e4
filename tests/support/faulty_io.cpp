// A library to be loaded before a program (LD_PRELOAD): a disk that fails, or a process that dies, at a call
// that writes. It counts the calls of the program and of all its forked processes together. The environment
// variables are:
//
// - FAULTY_FOLDER: files in this folder and below, and the folder itself; an absolute path without links
// - FAULTY_CALLS: which of write, fsync, rename, open (that makes a file), flock, close, mkdir, unlink,
// truncate (of
//   the size of a file); all of these by default; or of calls that write nothing: read, thread
//   (that is made)
// - FAULTY_AT: the number of the call that fails, from 1
// - FAULTY_FROM: or the first of those that fail, as on a disk that is full and stays so
// - FAULTY_ONE_IN: or each of them fails with one chance in so many, by FAULTY_SEED
// - FAULTY_WITH: ENOSPC, EIO, EROFS, EINVAL ..., or kill: this process, or kill-group: its group, after
//   half of what it writes; or empty: the call succeeds, and its file becomes empty before it; or stop-group:
//   the group stops before the call, until it gets SIGCONT, and the call succeeds
// - FAULTY_LOG: a file that gets a line for each fault: the call and the path
// - FAULTY_TRACE: a file that gets a line for each call that is counted: the call and the path, of a rename
// the old
//   path and the new one. It needs no fault.
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

struct Plan {
  std::string folder, calls, log, trace;
  unsigned long at = 0, from = 0, one_in = 0, seed = 0;
  int error = 0;
  int kills = 0;  ///< 1: the process, 2: its group
  bool empties = false;
  bool stops = false;                           ///< its group
  std::atomic<unsigned long>* count = nullptr;  ///< shared with forked processes
};

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

unsigned long number(const char* name) {
  return std::strtoul(variable(name).c_str(), nullptr, 10);
}

int error_of(const std::string& name) {
  for (int error = 1; error < 134; ++error)
    if (const char* known = ::strerrorname_np(error); known != nullptr && name == known) return error;
  return 0;
}

[[noreturn]] void refuse_plan(const char* why) {
  std::fprintf(stderr, "faulty_io: %s\n", why);
  ::_exit(99);
}

const Plan* made_plan() {
  static Plan plan{variable("FAULTY_FOLDER"), variable("FAULTY_CALLS"), variable("FAULTY_LOG"),
                   variable("FAULTY_TRACE"),  number("FAULTY_AT"),      number("FAULTY_FROM"),
                   number("FAULTY_ONE_IN"),   number("FAULTY_SEED")};
  if (plan.folder.empty()) return nullptr;
  const std::string with = variable("FAULTY_WITH");
  plan.kills = with == "kill" ? 1 : with == "kill-group" ? 2 : 0;
  plan.empties = with == "empty";
  plan.stops = with == "stop-group";
  plan.error = error_of(with);
  const bool has_fault = plan.kills > 0 || plan.empties || plan.stops || plan.error != 0;
  if (!has_fault && (plan.trace.empty() || !with.empty())) refuse_plan("FAULTY_WITH is not an error");
  void* shared =
      ::mmap(nullptr, sizeof *plan.count, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) refuse_plan("no memory to count in");
  plan.count = new (shared) std::atomic<unsigned long>(0);
  return &plan;
}

const Plan* plan() {
  static const Plan* const made = made_plan();
  return made;
}

// Before anything is forked.
[[gnu::constructor]] void begin() {
  (void)plan();
}

template <typename Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

std::string path_of(int fd) {
  char path[4096];
  const ssize_t size = ::readlink(("/proc/self/fd/" + std::to_string(fd)).c_str(), path, sizeof path);
  return size < 0 ? "" : std::string(path, static_cast<std::size_t>(size));
}

/// Links above the file do not matter here: the folder has none.
std::string path_of(const char* path) {
  if (path[0] == '/') return path;
  char folder[4096];
  return ::getcwd(folder, sizeof folder) == nullptr ? "" : std::string(folder) + '/' + path;
}

/// The path of a call relative to an open folder.
std::string path_in(int folder, const char* path) {
  if (path[0] == '/' || folder == AT_FDCWD) return path_of(path);
  return path_of(folder).append("/").append(path);
}

bool is_within(const std::string& path, const std::string& folder) {
  return path == folder || path.compare(0, folder.size() + 1, folder + '/') == 0;
}

bool writes_nothing(const std::string& call) {
  return call == "read" || call == "thread";
}

bool is_listed(const std::string& calls, const std::string& call) {
  return calls.empty() ? !writes_nothing(call)
                       : (',' + calls + ',').find(',' + call + ',') != std::string::npos;
}

/// Pseudo-random numbers, equal for the same call and seed.
unsigned long mixed(unsigned long x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9UL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebUL;
  return x ^ (x >> 31);
}

bool is_due(const Plan& p) {
  const unsigned long number = ++*p.count;
  return number == p.at || (p.from > 0 && number >= p.from) ||
         (p.one_in > 0 && mixed(mixed(p.seed) + number) % p.one_in == 0);
}

void remember(const std::string& log, const std::string& path, const char* call) {
  if (log.empty()) return;
  std::string line(call);
  line.append(" ").append(path).append("\n");
  const int fd = next<int(const char*, int, ...)>("open")(log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
  (void)!next<ssize_t(int, const void*, size_t)>("write")(fd, line.data(), line.size());
  next<int(int)>("close")(fd);
}

/// Whether the call fails; sets errno. `from` is the old path of a rename.
template <typename Place>
bool fails(const char* call, Place place, const std::string& from = "") {
  const Plan* p = plan();
  if (p == nullptr) return false;
  const int before = errno;
  const std::string path = path_of(place);
  errno = before;
  if (!is_listed(p->calls, call) || !is_within(path, p->folder)) return false;
  remember(p->trace, from + path, call);
  errno = before;
  if (!is_due(*p)) return false;
  remember(p->log, path, call);
  if (p->empties) {
    (void)!next<int(const char*, off_t)>("truncate")(path.c_str(), 0);
    errno = before;
    return false;
  }
  if (p->stops) {
    ::kill(0, SIGSTOP);
    errno = before;
    return false;
  }
  if (p->kills > 0) ::kill(p->kills == 2 ? 0 : ::getpid(), SIGKILL);
  errno = p->error;
  return true;
}

bool kills() {
  return plan() != nullptr && plan()->kills > 0;
}

}  // namespace

extern "C" {

ssize_t write(int fd, const void* bytes, size_t size) {
  static auto* const real = next<ssize_t(int, const void*, size_t)>("write");
  // Half of it is written before the process dies, so that a name given too early is detected.
  const size_t first = kills() && is_within(path_of(fd), plan()->folder) ? size / 2 : 0;
  const ssize_t begun = first > 0 ? real(fd, bytes, first) : 0;
  if (begun < 0 || fails("write", fd)) return -1;
  const ssize_t rest = real(fd, static_cast<const char*>(bytes) + begun, size - static_cast<size_t>(begun));
  return rest < 0 ? rest : begun + rest;
}

ssize_t pwrite(int fd, const void* bytes, size_t size, off_t offset) {
  static auto* const real = next<ssize_t(int, const void*, size_t, off_t)>("pwrite");
  return fails("write", fd) ? -1 : real(fd, bytes, size, offset);
}

ssize_t pwrite64(int fd, const void* bytes, size_t size, off64_t offset) {
  return pwrite(fd, bytes, size, offset);
}

ssize_t writev(int fd, const struct iovec* parts, int count) {
  static auto* const real = next<ssize_t(int, const struct iovec*, int)>("writev");
  return fails("write", fd) ? -1 : real(fd, parts, count);
}

int ftruncate(int fd, off_t size) noexcept {
  static auto* const real = next<int(int, off_t)>("ftruncate");
  return fails("truncate", fd) ? -1 : real(fd, size);
}

int ftruncate64(int fd, off64_t size) noexcept {
  return ftruncate(fd, size);
}

int posix_fallocate(int fd, off_t begin, off_t size) {
  static auto* const real = next<int(int, off_t, off_t)>("posix_fallocate");
  return fails("truncate", fd) ? errno : real(fd, begin, size);
}

int posix_fallocate64(int fd, off64_t begin, off64_t size) {
  return posix_fallocate(fd, begin, size);
}

int fdatasync(int fd) {
  static auto* const real = next<int(int)>("fdatasync");
  return fails("fsync", fd) ? -1 : real(fd);
}

int fsync(int fd) {
  static auto* const real = next<int(int)>("fsync");
  return fails("fsync", fd) ? -1 : real(fd);
}

int rename(const char* from, const char* to) noexcept {
  static auto* const real = next<int(const char*, const char*)>("rename");
  return fails("rename", to, path_of(from).append(" ")) ? -1 : real(from, to);
}

int renameat(int from_folder, const char* from, int to_folder, const char* to) noexcept {
  static auto* const real = next<int(int, const char*, int, const char*)>("renameat");
  const bool failed = fails("rename", path_in(to_folder, to).c_str(), path_in(from_folder, from).append(" "));
  return failed ? -1 : real(from_folder, from, to_folder, to);
}

int unlink(const char* path) noexcept {
  static auto* const real = next<int(const char*)>("unlink");
  return fails("unlink", path) ? -1 : real(path);
}

int remove(const char* path) noexcept {
  static auto* const real = next<int(const char*)>("remove");
  return fails("unlink", path) ? -1 : real(path);
}

int unlinkat(int folder, const char* path, int flags) noexcept {
  static auto* const real = next<int(int, const char*, int)>("unlinkat");
  return fails("unlink", path_in(folder, path).c_str()) ? -1 : real(folder, path, flags);
}

int open(const char* path, int flags, ...) {
  static auto* const real = next<int(const char*, int, ...)>("open");
  if ((flags & O_CREAT) == 0) return real(path, flags);
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = va_arg(rest, mode_t);
  va_end(rest);
  return fails("open", path) ? -1 : real(path, flags, mode);
}

ssize_t read(int fd, void* bytes, size_t size) {
  static auto* const real = next<ssize_t(int, void*, size_t)>("read");
  return fails("read", fd) ? -1 : real(fd, bytes, size);
}

int pthread_create(pthread_t* thread, const pthread_attr_t* facts, void* (*work)(void*), void* of) noexcept {
  static auto* const real =
      next<int(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*)>("pthread_create");
  const bool failed = plan() != nullptr && fails("thread", plan()->folder.c_str());
  return failed ? errno : real(thread, facts, work, of);
}

int flock(int fd, int operation) noexcept {
  static auto* const real = next<int(int, int)>("flock");
  return fails("flock", fd) ? -1 : real(fd, operation);
}

// The descriptor is closed in any case.
int close(int fd) {
  static auto* const real = next<int(int)>("close");
  const bool failed = fails("close", fd);
  const int error = errno, status = real(fd);
  if (failed) errno = error;
  return failed ? -1 : status;
}

int mkdir(const char* path, mode_t mode) noexcept {
  static auto* const real = next<int(const char*, mode_t)>("mkdir");
  return fails("mkdir", path) ? -1 : real(path, mode);
}
}
