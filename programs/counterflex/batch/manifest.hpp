#pragma once
/// Keeps the manifest of a batch, or of a shard, true while jobs end.
#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "batch/shards.hpp"
#include "counterflex/batch/manifest.hpp"

namespace counterflex::cli {

class BatchManifest {
 public:
  /// `path` of the file, and what it is the manifest of (`Manifest::plan`).
  BatchManifest(std::string path, std::string plan, BatchJobs jobs);

  /// Takes what is proven done by any of `files`, manifests of this batch, whoever wrote them. A file that is
  /// missing proves nothing. Throws `InputError` (Exit::machine_or_force) where one cannot be trusted;
  /// nothing has been changed then.
  void take_proven(const std::vector<std::string>& files);

  /// If its own file has all jobs, proven done or failed so that they would fail again, takes them and
  /// returns true. Throws as `take_proven`.
  bool take_all_ended();

  /// A job has ended.
  void set(std::size_t job, JobOutcome outcome);

  const BatchJobs& jobs() const { return jobs_; }
  const std::optional<JobOutcome>& outcome(std::size_t job) const { return outcomes_[job]; }
  std::vector<JobOutcome> ended() const;  ///< in the order of jobs

  /// Writes the file if something has changed and it has not been written for a while. What cannot be
  /// written then may be later.
  void save_sometimes();

  /// Throws `InputError` (Exit::transient_io) where it cannot be written.
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
