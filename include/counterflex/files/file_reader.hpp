#pragma once
/// Files of any size, read in order.
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace counterflex {

/// A file's bytes from its beginning, as often as wanted; "-" is standard input. What can be read only once,
/// a pipe, is copied to a nameless temporary file first. All members throw `InputError` where the file
/// cannot be read: ErrorKind::usage where no file exists that may be read, ErrorKind::transient_io where
/// reading fails.
class FileReader {
 public:
  explicit FileReader(const std::string& path);
  static FileReader of_bytes(std::string bytes);  ///< reads these bytes
  /// Reads the bytes of all `parts`, which are at their beginnings, one after the other.
  static FileReader joined(std::vector<FileReader> parts);
  ~FileReader();
  FileReader(FileReader&&) noexcept;

  /// Appends up to `most` bytes to `bytes`; how many, 0 only at the end.
  std::size_t append(std::string& bytes, std::size_t most);
  void rewind();

  /// From now on, bytes that are read for the first time are hashed on the way: `sha256` then need not read
  /// what has been read.
  void hash_along();

  /// Throws `InputError` (ErrorKind::transient_io) where the file is not what it was when it was opened, by
  /// size or time: what was read of it need not belong together.
  void refuse_change() const;

 private:
  FileReader();
  friend std::string sha256(FileReader& file);

  struct State;
  std::unique_ptr<State> state_;
};

/// SHA-256 of the whole file, which is at its beginning afterwards: 64 lower-case hexadecimal digits.
std::string sha256(FileReader& file);

}  // namespace counterflex
