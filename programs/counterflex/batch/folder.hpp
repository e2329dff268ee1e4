#pragma once
/// The folder of a batch: results, state and locks.
#include <string>
#include <vector>

#include "batch/jobs.hpp"
#include "counterflex/batch/folder_lock.hpp"
#include "process/console.hpp"

namespace counterflex::cli {

class BatchFolder {
 public:
  enum class Use {
    alone,   ///< no other run may write results here
    shared,  ///< other runs may do shards of the same batch
  };

  /// Creates missing folders, and locks those that results are written to until it is destroyed. Warns if
  /// their file system has no locks. With `alone`, removes unfinished files of killed runs. Throws
  /// `InputError` (ErrorKind::transient_io) if another run holds a lock, or if a folder cannot be written.
  BatchFolder(const Batch& batch, Use use, Console& console);

  /// Creates a folder of the state.
  void make_state(const std::string& name) const;

  /// The path of a file of the state.
  std::string state(const std::string& name) const;

  /// The manifests in the state folder: first that of the batch, then those of shards.
  std::vector<std::string> manifests() const;

  /// Removes unfinished files of killed workers. No other process may be writing. Does nothing if the folder
  /// is shared, or has no locks.
  void sweep() const;

 private:
  std::string folder_;
  std::vector<FolderLock> locks_;
  std::vector<std::string> outputs_;
  bool alone_ = false;
};

}  // namespace counterflex::cli
