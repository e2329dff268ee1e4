#pragma once
/// Files and folders as the operating system has them. Each system has its implementation, in src/files/posix
/// and src/files/win32.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

/// Descriptors are those of the C library: `read`, `write`, `lseek` and `close` take them. Paths are UTF-8 on
/// Windows, and bytes elsewhere. What fails sets errno and returns false, a negative number or nothing.
namespace counterflex::system {

enum class FileKind { file, folder, stream };  ///< stream: a pipe or a device

struct FileFacts {
  FileKind kind = FileKind::file;
  std::uint64_t device = 0, inode = 0, size = 0;
  std::int64_t written_ns = 0, changed_ns = 0;  ///< of the bytes; of bytes, name, owner or mode
  unsigned mode = 0;  ///< rights of owner, group and others, where the system has them
};

std::optional<FileFacts> facts_of(int descriptor);
std::optional<FileFacts> facts_of(const std::string& path);  ///< of what a link names

/// Whether standard output is this file.
bool is_standard_output(const std::string& path);

int open_to_read(const std::string& path);

/// A device or a pipe, to write to it. A pipe without a reader is an error: opening it would block for ever.
int open_stream(const std::string& path);

/// A file to read and write, which is made if it does not exist.
int open_or_make(const std::string& path);

/// A new file to write. `remove_abandoned` leaves it while this descriptor, or a copy of it, is open.
int make_file(const std::string& path);

/// Removes a file of `make_file` that no process has open. Whether it did.
bool remove_abandoned(const std::string& path);

/// An empty file without a name, in the folder for temporary files.
int make_nameless_file();

/// An empty folder there, which only this user may enter.
std::optional<std::string> make_temporary_folder();

/// Reads up to `most` bytes from `offset` on; how many. The position of the descriptor may change.
std::ptrdiff_t read_at(int descriptor, char* to, std::size_t most, std::size_t offset);

/// Moves to the end before it writes, where `read_at` may have changed the position.
bool append(int descriptor, std::string_view bytes);

/// Replaces the bytes of a file.
bool replace_text(int descriptor, std::string_view text);

bool set_mode(int descriptor, unsigned mode);
bool flush_to_disk(int descriptor);
bool make_folder(const std::string& path);
bool flush_names_to_disk(const std::string& folder);

/// Gives the file `from` the name `to`, which is replaced.
bool rename_file(const std::string& from, const std::string& to);

/// May be called by a handler of signals.
void remove_file(const char* path) noexcept;

/// Locks a file that is open for other holders of its lock, without waiting. errno is EWOULDBLOCK where
/// another process has it. It is free when the descriptor is closed, by the end of the process, too.
bool lock(int descriptor, bool exclusive);

/// Whether a name, without folders, matches `pattern`. Linux: glob(7), and a name that begins with a dot
/// matches no pattern that begins otherwise. Windows: `*` and `?`; case makes no difference.
bool matches(const std::string& pattern, const std::string& name);

/// Between the names of files of one variable of the environment.
extern const char list_separator;

/// A number of errno in words.
std::string reason_of(int error);

/// Of this computer; "?" if it has none.
std::string host_name();

}  // namespace counterflex::system
