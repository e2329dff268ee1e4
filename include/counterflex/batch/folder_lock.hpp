#pragma once
/// One run at a time in a folder, on one machine or on several that share it.
#include <string>
#include <string_view>

#include "counterflex/files/input_error.hpp"

namespace counterflex {

enum class LockKind {
  exclusive,  ///< no other holder
  shared,     ///< others that share it, too
};

/// A lock on FOLDER, by `flock` on FOLDER/.counterflex/lock: the system drops it when its holder is dead. It
/// is inherited by `fork`, not by `exec`, and is free when the last of these processes has ended. While it is
/// held exclusively, the file's text, one line "HOST PID COMMAND", names the holder. Otherwise the file is
/// empty: the next holder empties or replaces the text that a dead one has left.
class FolderLock {
 public:
  /// Makes the folders that are missing. Does not wait: throws `InputError` (ErrorKind::transient_io) naming
  /// the folder, and the holder where one is known, where another run has it, and with the reason where the
  /// lock's file cannot be made or opened.
  FolderLock(const std::string& folder, LockKind kind, std::string_view command);

  /// In the process that locked it: empties the file.
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept;

  /// False where the file system has no locks: other processes are not kept out.
  bool locked() const { return why_not_.empty(); }
  const std::string& why_not() const { return why_not_; }

 private:
  int fd_ = -1;
  long owner_ = 0;  ///< process that wrote the text; 0: none did
  std::string why_not_;
};

}  // namespace counterflex
