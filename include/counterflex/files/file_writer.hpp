#pragma once
/// Files that appear whole or not at all.
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace counterflex {

/// A file that is written in order to a temporary name in its folder, and gets its own name when it is
/// published; if it never is, nothing of it stays. Through a symbolic link the file that it names is
/// replaced, with its mode. "-" is standard output: that, pipes and devices are streams, which receive
/// everything at once when they are published. All members throw `InputError` (ErrorKind::transient_io)
/// naming the path where it cannot be written. A file that is published survives a power cut where its file
/// system can promise that; where the disk fails when only that is left to do, publishing throws although the
/// file has its name.
class FileWriter {
 public:
  explicit FileWriter(const std::string& path);
  ~FileWriter();
  FileWriter(FileWriter&&) noexcept;

  /// Call it before the first byte: the bytes are then hashed as they are written.
  void hash_along();

  void write(std::string_view bytes);

  /// Everything is on the disk, the name still the temporary one: for a file, all that is left is to rename
  /// it. A stream has received nothing yet. Nothing can be written any more.
  void complete();

  /// Completes it if need be.
  void publish();

  /// Publishes files, not streams: all are completed, then they get their names in this order, and at
  /// last their folders are synced. Where one cannot get its name, those behind it do not get theirs.
  static void publish_files(const std::vector<FileWriter*>& files);

  bool is_stream() const;
  const std::string& path() const;

  /// SHA-256 of the bytes passed to `write`, not of the bytes on disk; empty unless it is complete and
  /// hashed.
  const std::string& sha256() const;

 private:
  void rename();
  void send();

  struct State;
  std::unique_ptr<State> state_;
};

/// Removes what writers have not published yet, as a program that is interrupted must. Calls nothing that a
/// signal handler may not; no writer may be used afterwards.
void remove_unpublished() noexcept;

// Names of files that are being written: NAME.PID-COUNTER.tmp beside NAME; a long NAME is shortened in it.

/// The name under which process `pid` writes its `counter`-th file before that becomes `path`.
std::string temporary_name(const std::string& path, long pid, unsigned counter);

/// The part of the names of temporary files that identifies the file `name`: `name` itself, where it is short
/// enough.
std::string temporary_stem(const std::string& name);

/// The `temporary_stem` of the file that the temporary file `name` was to become; empty where `name` is not
/// the name of a temporary file.
std::string_view wanted_name(std::string_view name);

/// Removes what writers that were killed have left of `paths`, and nothing else; how many files. The caller
/// knows that no process writes them now. Files that cannot be removed stay.
std::size_t sweep_temporaries(const std::vector<std::string>& paths);

/// The same where others may write these paths now: their files, which they have locked, stay.
std::size_t sweep_abandoned(const std::vector<std::string>& paths);

}  // namespace counterflex
