#pragma once
/// What a watch remembers of the programs of its folder when it is started again.
#include <map>
#include <string>
#include <vector>

#include "counterflex/batch/manifest.hpp"

namespace counterflex::cli {

/// The files that corrected programs consist of besides those that the settings name: parts, and data lists
/// that have changed. Kept in FOLDER/.counterflex/watch.json. Programs are in the folder; names of outputs
/// are canonical.
class WatchRecord {
 public:
  /// Throws `InputError` (ErrorKind::machine_or_force) if the file is damaged.
  explicit WatchRecord(const std::string& folder);

  /// By path of the program.
  const std::map<std::string, JobOutcome>& programs() const { return programs_; }

  /// Whether each recorded file of the corrected program `output` is as it was written; true without
  /// recorded files.
  bool is_complete(const std::string& program, const std::string& output) const;

  /// Replaces what is known of a program, and of others that had one of these files. Throws `InputError`
  /// (ErrorKind::transient_io) if the file cannot be written.
  void set(const std::string& program, const std::string& output, const std::vector<FileHash>& files);

 private:
  void save() const;

  std::string path_;
  std::map<std::string, JobOutcome> programs_;
};

}  // namespace counterflex::cli
