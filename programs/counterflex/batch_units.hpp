#pragma once
/// What one run of a batch does: jobs, or the jobs and parts of jobs of a shard.
#include <optional>
#include <string>
#include <vector>

#include "batch_folder.hpp"
#include "batch_jobs.hpp"
#include "batch_manifest.hpp"
#include "batch_run.hpp"

namespace counterflex::cli {

struct BatchUnit {
  const BatchJob* job = nullptr;
  ShardUnit which;
  KeptUnit kept;  ///< of a part: its own key, and the file of its records
  bool is_part() const { return which.parts > 1; }
};

/// All jobs, each whole.
std::vector<BatchUnit> whole_jobs(const Batch& batch);

/// Those of all shards, by shard. Records are files of the state.
std::vector<std::vector<BatchUnit>> units_by_shard(const Batch& batch, int shards, const BatchFolder& folder);

/// What the manifest of a batch, or of the shards of one, is about: SHA-256 of all jobs, and of how they are
/// shared out.
std::string plan_of(const Batch& batch);
std::string plan_of(const std::vector<std::vector<BatchUnit>>& units_by_shard);

/// Borrows the unit.
BatchTask task_of(const BatchUnit& unit);

/// The job of a program whose parts were recorded in `records`. Borrows the job.
BatchTask merging_task(const BatchJob& job, std::vector<std::string> records);

/// Does those of `units` whose outcome `manifest` does not hold, in the same order, and keeps it true. The
/// signal by which it was stopped, if any.
std::optional<int> do_missing(const std::vector<BatchTask>& tasks, int threads, BatchManifest& manifest,
                              Console& console);

}  // namespace counterflex::cli
