#pragma once
/// Divides the jobs of a batch into shards.
#include <string>
#include <vector>

#include "batch/jobs.hpp"

namespace counterflex::cli {

/// Some jobs of a batch. The batch outlives the list.
using BatchJobs = std::vector<const BatchJob*>;

BatchJobs all_jobs(const Batch& batch);

/// The jobs of each of `shards` shards. Those with a data list in common are in one shard.
std::vector<BatchJobs> jobs_by_shard(const Batch& batch, int shards);

/// SHA-256 of the keys of all jobs and of their assignment to shards.
std::string plan_of(const std::vector<BatchJobs>& jobs_by_shard);

}  // namespace counterflex::cli
