#include "batch/shards.hpp"

#include "counterflex/files/files.hpp"

namespace counterflex::cli {

BatchJobs all_jobs(const Batch& batch) {
  BatchJobs jobs;
  for (const BatchJob& job : batch.jobs) jobs.push_back(&job);
  return jobs;
}

std::vector<BatchJobs> jobs_by_shard(const Batch& batch, int shards) {
  std::vector<double> work;
  for (const BatchJob& job : batch.jobs) work.push_back(job.work);
  std::vector<BatchJobs> by_shard;
  for (const std::vector<std::size_t>& indices : plan_shards(work, shards)) {
    BatchJobs& jobs = by_shard.emplace_back();
    for (const std::size_t index : indices) jobs.push_back(&batch.jobs[index]);
  }
  return by_shard;
}

std::string plan_of(const std::vector<BatchJobs>& jobs_by_shard) {
  std::string keys;
  for (const BatchJobs& jobs : jobs_by_shard) {
    for (const BatchJob* job : jobs) keys += job->key + "\n";
    keys += "\n";
  }
  return sha256(keys);
}

}  // namespace counterflex::cli
