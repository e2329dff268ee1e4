#include "watched_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fnmatch.h>
#include <linux/magic.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <initializer_list>
#include <optional>

#include "counterflex/files/file_reader.hpp"
#include "counterflex/files/input_error.hpp"
#include "counterflex/files/sha256.hpp"

namespace counterflex::cli {
namespace {

constexpr std::uint32_t heard_of =
    IN_CLOSE_WRITE | IN_MOVED_TO | IN_CREATE | IN_DELETE_SELF | IN_MOVE_SELF | IN_ONLYDIR;
constexpr std::uint32_t end_of_folder = IN_DELETE_SELF | IN_MOVE_SELF | IN_UNMOUNT | IN_IGNORED;

/// What is linked is heard of but once, whatever becomes of its other names and even where somebody still
/// has it open; a new file is empty, and will be closed.
bool is_linked(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_symlink(path, error)) return true;
  return std::filesystem::is_regular_file(path, error) && std::filesystem::file_size(path, error) > 0 &&
         !error;
}

/// Without regard to case: programs that write for other systems shout.
bool ends_with_any(const std::string& name, std::initializer_list<std::string_view> endings) {
  std::string lower = name;
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::any_of(endings.begin(), endings.end(),
                     [&](std::string_view end) { return lower.ends_with(end); });
}

bool is_hidden_or_temporary(const std::string& name) {
  return name.empty() || name.front() == '.' || name.front() == '#' || name.starts_with("~$") ||
         ends_with_any(name, {"~", ".tmp", ".temp", ".part", ".partial", ".filepart", ".crdownload", ".swp",
                              ".bak", ".lock"});
}

bool is_no_program(const std::string& name) {
  return ends_with_any(name, {".toml", ".csv", ".json", ".html", ".svg"});
}

/// The first bytes of a file, enough for a header; none where it cannot be read.
std::string beginning_of(const std::string& path) {
  constexpr std::size_t enough = 1 << 14;
  std::string bytes;
  try {
    FileReader(path).append(bytes, enough);
  } catch (const InputError&) {
    return {};
  }
  return bytes;
}

/// The digits of its program's hash in the header of a corrected program; empty where it has none.
std::string program_digits(const std::string& path) {
  constexpr std::size_t count = 16;
  constexpr std::string_view mark = "COUNTERFLEX 1 PROGRAM ";
  const std::string bytes = beginning_of(path);
  const std::size_t at = bytes.find(mark);
  if (at == std::string::npos) return {};
  const std::string digits = bytes.substr(at + mark.size(), count);
  const bool complete = digits.size() == count && std::all_of(digits.begin(), digits.end(), [](unsigned char c) {
    return std::isxdigit(c) != 0;
  });
  return complete ? digits : std::string();
}

/// Where writers may be on other computers, of whom the system here does not know.
bool is_on_server(int file) {
  constexpr std::uint32_t nfs = NFS_SUPER_MAGIC, smb = SMB_SUPER_MAGIC, smb2 = 0xFE534D42, cifs = 0xFF534D42,
                          fuse = 0x65735546, plan9 = V9FS_MAGIC, ceph = 0x00C36400, afs = AFS_FS_MAGIC;
  struct statfs facts {};
  if (::fstatfs(file, &facts) != 0) return false;
  const auto type = static_cast<std::uint32_t>(facts.f_type);
  const auto servers = {nfs, smb, smb2, cifs, fuse, plan9, ceph, afs};
  return std::find(servers.begin(), servers.end(), type) != servers.end();
}

/// Whether it has been written in the last seconds.
bool is_fresh(int file) {
  constexpr std::time_t rest_s = 5;
  struct stat facts {};
  if (::fstat(file, &facts) != 0) return false;
  const std::time_t age = std::time(nullptr) - facts.st_mtime;
  return age < rest_s && age > -60;  // the clock of a server may be ahead; times far off say nothing
}

/// A lease to read is refused where somebody writes. Whoever opens the file to write meanwhile waits until it
/// is given back, when the file is closed; the signal about that is ignored. Nothing where the system does
/// not tell: of another user's file, and where there are no leases.
std::optional<bool> has_writer(int file) {
  if (::fcntl(file, F_SETLEASE, F_RDLCK) == 0) return false;
  return errno == EAGAIN ? std::optional(true) : std::nullopt;
}

}  // namespace

WatchedFolder::WatchedFolder(const std::string& path) : path_(path) {
  descriptor_ = ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  struct stat facts {};
  if (descriptor_ >= 0 && ::stat(path.c_str(), &facts) == 0 &&
      ::inotify_add_watch(descriptor_, path.c_str(), heard_of) >= 0) {
    device_ = facts.st_dev;
    inode_ = facts.st_ino;
    return;
  }
  const int reason = errno;
  if (descriptor_ >= 0) ::close(descriptor_);
  const bool of_path = reason == ENOENT || reason == ENOTDIR || reason == EACCES;
  throw InputError(of_path ? Exit::usage : Exit::transient_io, {path},
                   fmt::format("cannot watch the folder: {}", std::strerror(reason)));
}

WatchedFolder::~WatchedFolder() {
  ::close(descriptor_);
}

std::vector<WatchedFolder::Event> WatchedFolder::events() {
  std::vector<Event> events;
  alignas(inotify_event) std::array<char, 1 << 14> bytes;
  for (ssize_t n; (n = ::read(descriptor_, bytes.data(), bytes.size())) > 0;)
    for (const char* at = bytes.data(); at < bytes.data() + n;) {
      const auto& event = *reinterpret_cast<const inotify_event*>(at);
      events.push_back({event.mask, event.len > 0 ? event.name : ""});
      at += sizeof event + event.len;
    }
  return events;
}

bool WatchedFolder::is_still_there() const {
  struct stat facts {};
  return ::stat(path_.c_str(), &facts) == 0 && facts.st_dev == device_ && facts.st_ino == inode_;
}

WatchedFolder::News WatchedFolder::read() {
  if (!is_still_there()) gone();
  News news;
  for (const Event& event : events()) {
    if ((event.mask & end_of_folder) != 0) gone();
    if ((event.mask & IN_Q_OVERFLOW) != 0) news.lost = true;
    if (event.name.empty() || (event.mask & IN_ISDIR) != 0) continue;
    if ((event.mask & IN_CREATE) == 0 || is_linked(path_of(event.name))) news.names.push_back(event.name);
  }
  return news;
}

void WatchedFolder::gone() const {
  throw InputError(Exit::transient_io, {path_},
                   "the watched folder was removed, or renamed, or another one has its path");
}

std::vector<std::string> WatchedFolder::names() const {
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(path_, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code unknown;
    if (entry->is_regular_file(unknown)) names.push_back(entry->path().filename().string());
  }
  if (error) throw InputError(Exit::transient_io, {path_}, "cannot read the folder: " + error.message());
  std::sort(names.begin(), names.end());
  return names;
}

std::string WatchedFolder::path_of(const std::string& name) const {
  return (std::filesystem::path(path_) / name).string();
}

bool may_be_program(const std::string& name, const std::vector<std::string>& patterns) {
  if (is_hidden_or_temporary(name)) return false;
  if (patterns.empty()) return !is_no_program(name);
  return std::any_of(patterns.begin(), patterns.end(), [&](const std::string& pattern) {
    return ::fnmatch(pattern.c_str(), name.c_str(), FNM_PERIOD) == 0;
  });
}

bool is_being_written(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return false;
  const bool busy = is_on_server(file) ? is_fresh(file) : has_writer(file).value_or(is_fresh(file));
  ::close(file);
  return busy;
}

bool has_corrected_header(const std::string& path) {
  return !program_digits(path).empty();
}

bool is_corrected_from(const std::string& output, const std::string& program,
                       const std::function<bool()>& stop) {
  constexpr std::size_t portion = 1 << 20;
  const std::string known = program_digits(output);
  if (known.empty()) return false;
  Sha256 hash;
  try {
    FileReader reader(program);
    for (std::string read; reader.append(read, portion) > 0; read.clear()) {
      if (stop()) return false;
      hash.add(read);
    }
  } catch (const InputError&) {
    return false;
  }
  return std::equal(known.begin(), known.end(), hash.digits().begin(), [](unsigned char known_digit, unsigned char digit) {
    return std::tolower(known_digit) == std::tolower(digit);
  });
}

}  // namespace counterflex::cli
