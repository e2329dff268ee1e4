#pragma once
/// A folder in which programs appear, and what of it is to be compensated.
#include <string>
#include <vector>

namespace counterflex::cli {

/// Hears of files that are complete: closed by who wrote them, moved in, or linked.
class WatchedFolder {
 public:
  /// Throws `InputError`: Exit::usage where it is no folder, Exit::transient_io where it cannot be watched.
  explicit WatchedFolder(const std::string& path);
  ~WatchedFolder();
  WatchedFolder(const WatchedFolder&) = delete;
  WatchedFolder& operator=(const WatchedFolder&) = delete;

  struct News {
    std::vector<std::string> names;  ///< of files, in the order of what happened; one may come twice
    bool lost = false;               ///< there was more than the system remembers
  };

  /// What has happened since the last time, without waiting. Throws `InputError` (Exit::transient_io) where
  /// the folder is there no more.
  News read();

  /// To wait for.
  int descriptor() const { return descriptor_; }

  /// Names of the files in it, sorted. Throws `InputError` (Exit::transient_io) where it cannot be read.
  std::vector<std::string> names() const;

  std::string path_of(const std::string& name) const;

 private:
  [[noreturn]] void gone() const;

  std::string path_;
  int descriptor_ = -1;
};

/// Whether a file of this name is to be looked at: not where it is hidden, temporary, or what counterflex
/// reads and writes beside programs. Where there are `patterns`, as a shell has them, it also matches one of
/// these, which may ask for what else counterflex reads and writes.
bool may_be_program(const std::string& name, const std::vector<std::string>& patterns);

/// Whether somebody has the file open to write; where the system does not tell, of a file on a server or of
/// another user, whether it has been written in the last five seconds.
bool is_being_written(const std::string& path);

/// Whether the file starts as a corrected program.
bool has_corrected_header(const std::string& path);

/// Whether the header of the corrected program at `output` names the bytes of `program`.
bool is_corrected_from(const std::string& output, const std::string& program);

}  // namespace counterflex::cli
