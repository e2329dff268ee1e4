#pragma once
/// Finds the programs of a folder by polling.
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace counterflex::cli {

/// Different for each version of a file.
struct FileVersion {
  std::uint64_t device = 0, inode = 0, size = 0;
  std::int64_t written_ns = 0, changed_ns = 0;  ///< of the bytes; of bytes, name, owner or mode
  bool operator==(const FileVersion&) const = default;
};

/// Ignores hidden, temporary and empty files, and other files that counterflex reads or writes. With
/// `patterns`, as in a shell, a name must match one of them; patterns can include .csv, .toml, .json, .html
/// and .svg. The data list beside a KUKA program is a part of this program: if the list changes, arrives or
/// vanishes, the program has changed.
class WatchedFiles {
 public:
  /// Throws `InputError` (ErrorKind::usage) if `folder` is not a folder.
  WatchedFiles(std::string folder, std::vector<std::string> patterns);

  /// Throws `InputError` (ErrorKind::transient_io) if the folder can no longer be read.
  void poll();

  /// Sorted paths of files that have changed since `set_done`: those that were equal at the last two polls,
  /// and those that were not.
  std::vector<std::string> complete() const { return undone(true); }
  std::vector<std::string> changing() const { return undone(false); }

  /// Whether the file has not changed since the first poll.
  bool is_from_start(const std::string& path) const { return files_.at(path).is_from_start; }
  bool contains(const std::string& path) const { return files_.contains(path); }
  std::vector<std::string> all() const;  ///< sorted paths
  void set_done(const std::string& path) { files_.at(path).is_done = true; }

 private:
  struct File {
    FileVersion version;
    std::optional<FileVersion> list;  ///< of the data list beside it
    bool is_from_start = false, is_complete = false, is_done = false;
  };

  std::vector<std::string> undone(bool complete) const;

  std::string folder_;
  std::vector<std::string> patterns_;
  std::map<std::string, File> files_;  ///< by path
  bool is_first_poll_ = true;
};

}  // namespace counterflex::cli
