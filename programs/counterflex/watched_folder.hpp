#pragma once
/// A folder in which programs appear, and what of it is to be compensated.
#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace counterflex::cli {

/// Hears of files that are complete: closed by who wrote them or moved in; and of those that are linked,
/// which somebody may still have open.
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
  /// the folder is there no more, or its path leads to another one: of that a folder itself hears nothing
  /// where one above it is renamed, so ask now and then.
  News read();

  /// To wait for.
  int descriptor() const { return descriptor_; }

  /// Names of the files in it, sorted. Throws `InputError` (Exit::transient_io) where it cannot be read.
  std::vector<std::string> names() const;

  std::string path_of(const std::string& name) const;

 private:
  struct Event {
    std::uint32_t mask = 0;
    std::string name{};
  };

  bool is_still_there() const;
  std::vector<Event> events();  ///< since the last time
  [[noreturn]] void gone() const;

  std::string path_;
  int descriptor_ = -1;
  dev_t device_ = 0;
  ino_t inode_ = 0;
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

/// Whether the header of the corrected program at `output` names the bytes of `program`. False, too, where
/// `stop` wants that while they are read.
bool is_corrected_from(const std::string& output, const std::string& program,
                       const std::function<bool()>& stop);

}  // namespace counterflex::cli
