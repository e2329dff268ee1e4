#pragma once
/// What a watch remembers of the programs of its folder when it is started again.
#include <map>
#include <string>

#include "batch/jobs.hpp"
#include "counterflex/batch/manifest.hpp"

namespace counterflex::cli {

/// The outcomes of corrected programs. Kept in FOLDER/.counterflex/watch.json. Programs are in the folder;
/// names of outputs are canonical.
class WatchRecord {
 public:
  /// Throws `InputError` (ErrorKind::machine_or_force) if the file is damaged.
  explicit WatchRecord(const std::string& folder);

  /// By path of the program.
  const std::map<std::string, JobOutcome>& programs() const { return programs_; }

  /// Whether the job was done with the same options and inputs, and its outputs are as they were written. The
  /// corrected program itself needs its header only: people may edit it.
  bool is_done(const BatchJob& job, FileHashes& on_disk) const;

  /// Replaces what is known of the program, and of others that had one of its outputs. Throws `InputError`
  /// (ErrorKind::transient_io) if the file cannot be written.
  void set(const std::string& program, JobOutcome outcome);

 private:
  void save() const;

  std::string path_;
  std::map<std::string, JobOutcome> programs_;
};

}  // namespace counterflex::cli
