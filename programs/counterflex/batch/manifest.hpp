#pragma once
/// Updates the manifest of a batch, or of a shard, as jobs end.
#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "batch/shards.hpp"
#include "counterflex/batch/manifest.hpp"

namespace counterflex::cli {

/// Whether the recorded outcome is that of the job as it is now: `is_proven`, or a failure with the same
/// options and with the inputs, those that exist, as they were.
bool is_current(const JobOutcome& recorded, const BatchJob& job, FileHashes& on_disk);

class BatchManifest {
 public:
  /// `path` of the file, and the plan of its jobs (`Manifest::plan`).
  BatchManifest(std::string path, std::string plan, BatchJobs jobs);

  /// Takes over outcomes from `files`, manifests of this batch, for jobs whose options, inputs and outputs
  /// match. Ignores missing files. Throws `InputError` (ErrorKind::machine_or_force) for a damaged manifest,
  /// and then changes nothing.
  void take_proven(const std::vector<std::string>& files);

  /// Takes over the outcomes of its own file and returns true if it has all jobs, each unchanged or sure to
  /// fail again. Throws as `take_proven`.
  bool take_all_ended();

  /// A job has ended.
  void set(std::size_t job, JobOutcome outcome);

  const BatchJobs& jobs() const { return jobs_; }
  const std::optional<JobOutcome>& outcome(std::size_t job) const { return outcomes_[job]; }
  std::vector<JobOutcome> ended() const;  ///< in the order of jobs

  /// Writes the file if an outcome was added and the last write was some time ago. Ignores errors: the next
  /// call tries again.
  void save_sometimes();

  /// Throws `InputError` (ErrorKind::transient_io) if it cannot be written.
  void save();

 private:
  std::vector<std::optional<JobOutcome>> recorded(const std::vector<std::string>& files,
                                                  bool failed_too) const;

  std::string path_, plan_;
  BatchJobs jobs_;
  std::vector<std::optional<JobOutcome>> outcomes_;
  bool changed_ = true;
  std::chrono::steady_clock::time_point saved_{};
};

}  // namespace counterflex::cli
