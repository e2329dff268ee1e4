#include "counterflex/files/system.hpp"

#include <fcntl.h>
#include <io.h>
#include <shlwapi.h>
#include <unistd.h>
#include <windows.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <cwchar>
#include <filesystem>
#include <utility>

#include "counterflex/files/text.hpp"
#include "files/descriptor.hpp"

/// libstdc++ makes paths from bytes by `mbrtowc`, which has the code page of the computer here, and bytes
/// from paths as UTF-8. The linker replaces that function by this one, for which bytes are UTF-8. Of a
/// character of four bytes, the first three give the first half, and the last gives the second half, which
/// `state` holds.
extern "C" std::size_t __wrap_mbrtowc(wchar_t* to, const char* from, std::size_t most,
                                      std::mbstate_t* state) {
  if (most == 0) return static_cast<std::size_t>(-2);
  if (*state != 0) {
    *to = static_cast<wchar_t>(std::exchange(*state, 0));
    return 1;
  }
  const std::string_view character = counterflex::first_character({from, most});
  std::array<wchar_t, 2> halves{};
  const int count = ::MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, character.data(),
                                          static_cast<int>(character.size()), halves.data(), 2);
  if (count == 0) {
    errno = EILSEQ;
    return static_cast<std::size_t>(-1);
  }
  *to = halves[0];
  if (count == 2) *state = halves[1];
  return count == 2 ? character.size() - 1 : halves[0] == 0 ? 0 : character.size();
}

namespace counterflex::system {
namespace {

constexpr DWORD share_all = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;
constexpr DWORD lock_begins = 0x40000000;  // of 4 GB: far behind the text of the file, which others may read

/// Sets errno from the system's last error.
void take_error() {
  struct Known {
    DWORD code;
    int error;
  };
  constexpr std::array known{Known{ERROR_FILE_NOT_FOUND, ENOENT},
                             Known{ERROR_PATH_NOT_FOUND, ENOENT},
                             Known{ERROR_INVALID_DRIVE, ENOENT},
                             Known{ERROR_BAD_NETPATH, ENOENT},
                             Known{ERROR_INVALID_NAME, ENOENT},
                             Known{ERROR_DIRECTORY, ENOTDIR},
                             Known{ERROR_FILENAME_EXCED_RANGE, ENAMETOOLONG},
                             Known{ERROR_ACCESS_DENIED, EACCES},
                             Known{ERROR_SHARING_VIOLATION, EBUSY},
                             Known{ERROR_LOCK_VIOLATION, EWOULDBLOCK},
                             Known{ERROR_IO_PENDING, EWOULDBLOCK},
                             Known{ERROR_WRITE_PROTECT, EROFS},
                             Known{ERROR_FILE_EXISTS, EEXIST},
                             Known{ERROR_ALREADY_EXISTS, EEXIST},
                             Known{ERROR_DISK_FULL, ENOSPC},
                             Known{ERROR_HANDLE_DISK_FULL, ENOSPC},
                             Known{ERROR_NOT_SUPPORTED, ENOSYS},
                             Known{ERROR_INVALID_FUNCTION, ENOSYS},
                             Known{ERROR_NO_DATA, EPIPE},
                             Known{ERROR_BROKEN_PIPE, EPIPE}};
  const DWORD code = ::GetLastError();
  errno = EIO;
  for (const Known& error : known)
    if (error.code == code) errno = error.error;
}

/// Closes its handle on destruction.
class Handle {
 public:
  explicit Handle(HANDLE handle) : handle_(handle) {}
  ~Handle() {
    if (is_open()) ::CloseHandle(handle_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  bool is_open() const { return handle_ != INVALID_HANDLE_VALUE; }
  HANDLE get() const { return handle_; }
  HANDLE release() { return std::exchange(handle_, INVALID_HANDLE_VALUE); }

 private:
  HANDLE handle_;
};

HANDLE handle_of(int descriptor) {
  return reinterpret_cast<HANDLE>(::_get_osfhandle(descriptor));
}

/// The text of `path` for the system.
std::wstring wide(const std::string& path) {
  try {
    return std::filesystem::path(path).wstring();
  } catch (const std::filesystem::filesystem_error&) {  // not UTF-8: no file has such a name
    return L"?";
  }
}

HANDLE open(const std::string& path, DWORD access, DWORD share, DWORD how, DWORD flags) {
  const HANDLE file = ::CreateFileW(wide(path).c_str(), access, share, nullptr, how, flags, nullptr);
  if (file == INVALID_HANDLE_VALUE) take_error();
  return file;
}

/// Bytes are not changed at line ends, and child processes do not inherit the file.
int descriptor_of(HANDLE file, int access) {
  if (file == INVALID_HANDLE_VALUE) return -1;
  Handle held(file);
  const int descriptor =
      ::_open_osfhandle(reinterpret_cast<std::intptr_t>(file), access | _O_BINARY | _O_NOINHERIT);
  if (descriptor >= 0) held.release();
  return descriptor;
}

std::int64_t nanoseconds_of(const FILETIME& time) {
  constexpr std::int64_t unit = 100;
  return static_cast<std::int64_t>(std::uint64_t{time.dwHighDateTime} << 32 | time.dwLowDateTime) * unit;
}

std::optional<FileFacts> facts(HANDLE file) {
  FileFacts facts{.kind = FileKind::stream};
  if (::GetFileType(file) != FILE_TYPE_DISK) return facts;
  BY_HANDLE_FILE_INFORMATION found;
  if (::GetFileInformationByHandle(file, &found) == 0) {
    take_error();
    return std::nullopt;
  }
  const bool is_folder = (found.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0;
  facts.kind = is_folder ? FileKind::folder : FileKind::file;
  facts.device = found.dwVolumeSerialNumber;
  facts.inode = std::uint64_t{found.nFileIndexHigh} << 32 | found.nFileIndexLow;
  facts.size = std::uint64_t{found.nFileSizeHigh} << 32 | found.nFileSizeLow;
  facts.written_ns = nanoseconds_of(found.ftLastWriteTime);
  facts.changed_ns = facts.written_ns;
  return facts;
}

/// The result of `make`, which is called with unused names of temporary files until one is not taken by
/// another process.
template <typename Make>
HANDLE with_temporary_name(const Make& make) {
  static std::atomic<unsigned> counter{0};
  std::array<wchar_t, MAX_PATH + 1> folder{};
  if (::GetTempPathW(static_cast<DWORD>(folder.size()), folder.data()) == 0) {
    take_error();
    return INVALID_HANDLE_VALUE;
  }
  for (;;) {
    const HANDLE made = make(std::wstring(folder.data()) + L"counterflex-" + std::to_wstring(::_getpid()) +
                             L"-" + std::to_wstring(counter++) + L".tmp");
    if (made != INVALID_HANDLE_VALUE) return made;
    take_error();
    if (errno != EEXIST) return made;
  }
}

OVERLAPPED at(std::uint64_t offset) {
  OVERLAPPED place{};
  place.Offset = static_cast<DWORD>(offset);
  place.OffsetHigh = static_cast<DWORD>(offset >> 32);
  return place;
}

}  // namespace

std::optional<FileFacts> facts_of(int descriptor) {
  const HANDLE file = handle_of(descriptor);
  // Wine knows no facts of a file that Linux has opened. As a stream it can be read.
  if (file != INVALID_HANDLE_VALUE) return facts(file).value_or(FileFacts{.kind = FileKind::stream});
  errno = EBADF;
  return std::nullopt;
}

std::optional<FileFacts> facts_of(const std::string& path) {
  const Handle file(open(path, 0, share_all, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS));
  if (!file.is_open()) return std::nullopt;
  return facts(file.get());
}

int open_to_read(const std::string& path) {
  const HANDLE file = open(path, GENERIC_READ, share_all, OPEN_EXISTING, FILE_ATTRIBUTE_NORMAL);
  std::error_code ignored;
  if (file == INVALID_HANDLE_VALUE && errno == EACCES && std::filesystem::is_directory(path, ignored))
    errno = EISDIR;
  return descriptor_of(file, _O_RDONLY);
}

int open_stream(const std::string& path) {
  return descriptor_of(open(path, GENERIC_WRITE, share_all, OPEN_EXISTING, FILE_ATTRIBUTE_NORMAL), _O_WRONLY);
}

int open_or_make(const std::string& path) {
  return descriptor_of(
      open(path, GENERIC_READ | GENERIC_WRITE, share_all, OPEN_ALWAYS, FILE_ATTRIBUTE_NORMAL), _O_RDWR);
}

/// An interrupted process removes it while it is open.
int make_file(const std::string& path) {
  constexpr DWORD share = FILE_SHARE_READ | FILE_SHARE_DELETE;
  return descriptor_of(open(path, GENERIC_WRITE, share, CREATE_NEW, FILE_ATTRIBUTE_NORMAL), _O_WRONLY);
}

/// The system refuses to open it where no other process may write it.
bool remove_abandoned(const std::string& path) {
  constexpr DWORD share = FILE_SHARE_READ | FILE_SHARE_DELETE;
  const Handle file(open(path, GENERIC_READ, share, OPEN_EXISTING, FILE_FLAG_OPEN_REPARSE_POINT));
  return file.is_open() && ::DeleteFileW(wide(path).c_str()) != 0;
}

int make_nameless_file() {
  const HANDLE file = with_temporary_name([](const std::wstring& name) {
    return ::CreateFileW(name.c_str(), GENERIC_READ | GENERIC_WRITE, FILE_SHARE_DELETE, nullptr, CREATE_NEW,
                         FILE_ATTRIBUTE_TEMPORARY | FILE_FLAG_DELETE_ON_CLOSE, nullptr);
  });
  return descriptor_of(file, _O_RDWR);
}

/// The folder for temporary files is the user's own.
std::optional<std::string> make_temporary_folder() {
  std::optional<std::string> made;
  with_temporary_name([&](const std::wstring& name) {
    if (::CreateDirectoryW(name.c_str(), nullptr) == 0) return INVALID_HANDLE_VALUE;
    made = std::filesystem::path(name).string();
    return HANDLE{};
  });
  return made;
}

std::ptrdiff_t read_at(int descriptor, char* to, std::size_t most, std::size_t offset) {
  constexpr std::size_t at_once = std::size_t{1} << 30;
  OVERLAPPED place = at(offset);
  DWORD count = 0;
  if (::ReadFile(handle_of(descriptor), to, static_cast<DWORD>(std::min(most, at_once)), &count, &place) != 0)
    return count;
  if (::GetLastError() == ERROR_HANDLE_EOF) return 0;
  take_error();
  return -1;
}

bool append(int descriptor, std::string_view bytes) {
  return ::lseek(descriptor, 0, SEEK_END) >= 0 && write_all(descriptor, bytes);
}

bool replace_text(int descriptor, std::string_view text) {
  return ::lseek(descriptor, 0, SEEK_SET) == 0 && ::ftruncate(descriptor, 0) == 0 &&
         write_all(descriptor, text);
}

/// Rights are those of the folder.
bool set_mode(int, unsigned) {
  return true;
}

bool flush_to_disk(int descriptor) {
  return ::_commit(descriptor) == 0;
}

bool make_folder(const std::string& path) {
  if (::CreateDirectoryW(wide(path).c_str(), nullptr) != 0) return true;
  take_error();
  return false;
}

/// The file system's journal does it.
bool flush_names_to_disk(const std::string&) {
  return true;
}

bool rename_file(const std::string& from, const std::string& to) {
  if (::MoveFileExW(wide(from).c_str(), wide(to).c_str(),
                    MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH) != 0)
    return true;
  take_error();
  const DWORD facts = ::GetFileAttributesW(wide(to).c_str());
  constexpr DWORD forbidding = FILE_ATTRIBUTE_READONLY | FILE_ATTRIBUTE_DIRECTORY;
  if (errno == EACCES && facts != INVALID_FILE_ATTRIBUTES && (facts & forbidding) == 0) errno = EBUSY;
  return false;
}

/// Windows calls handlers of signals on a thread of their own.
void remove_file(const char* path) noexcept {
  std::array<wchar_t, 4096> name{};
  if (::MultiByteToWideChar(CP_UTF8, 0, path, -1, name.data(), static_cast<int>(name.size())) > 0)
    ::DeleteFileW(name.data());
}

bool lock(int descriptor, bool exclusive) {
  OVERLAPPED place = at(lock_begins);
  const DWORD flags = LOCKFILE_FAIL_IMMEDIATELY | (exclusive ? LOCKFILE_EXCLUSIVE_LOCK : 0);
  if (::LockFileEx(handle_of(descriptor), flags, 0, 1, 0, &place) != 0) return true;
  take_error();
  return false;
}

bool matches(const std::string& pattern, const std::string& name) {
  return ::PathMatchSpecExW(wide(name).c_str(), wide(pattern).c_str(),
                            PMSF_NORMAL | PMSF_DONT_STRIP_SPACES) == S_OK;
}

const char list_separator = ';';

std::string reason_of(int error) {
  return error == EBUSY ? "another program has opened it" : std::strerror(error);
}

std::string host_name() {
  std::array<char, MAX_COMPUTERNAME_LENGTH + 1> name{};
  auto size = static_cast<DWORD>(name.size());
  return ::GetComputerNameA(name.data(), &size) != 0 ? name.data() : "?";
}

}  // namespace counterflex::system
