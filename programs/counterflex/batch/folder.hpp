#pragma once
/// The folder of a batch: its results, its state, and who may work in it.
#include <string>
#include <vector>

#include "batch/jobs.hpp"
#include "counterflex/batch/folder_lock.hpp"
#include "process/console.hpp"

namespace counterflex::cli {

class BatchFolder {
 public:
  enum class Use {
    alone,   ///< nobody else may write results here
    shared,  ///< with others that do shards of the same batch
  };

  /// Makes the folders that are missing, and locks those that results are written to while it lives. Warns
  /// where their file system has no locks. Alone, it removes what runs that were killed have left half
  /// written. Throws `InputError` (Exit::transient_io) where another run holds one, or it cannot be written.
  BatchFolder(const Batch& batch, Use use, Console& console);

  /// Makes a folder of the state.
  void make_state(const std::string& name) const;

  /// The path of a file of the state.
  std::string state(const std::string& name) const;

  /// The manifests that stand in the state: of the batch, then of shards.
  std::vector<std::string> manifests() const;

  /// Removes what is half written, of workers that were killed; nobody else may be writing then. Nothing
  /// where the folder is shared, or there are no locks.
  void sweep() const;

 private:
  std::string folder_;
  std::vector<FolderLock> locks_;
  std::vector<std::string> outputs_;
  bool alone_ = false;
};

}  // namespace counterflex::cli
