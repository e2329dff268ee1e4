#include "batch/shards.hpp"

#include <algorithm>
#include <map>

#include "counterflex/files/files.hpp"

namespace counterflex::cli {
namespace {

/// Indices of jobs that are in one shard.
using JobGroup = std::vector<std::size_t>;

/// Jobs that have data lists in common, also over other jobs, are one group. In the order of the first jobs.
std::vector<JobGroup> groups_of(const std::vector<BatchJob>& jobs) {
  std::vector<JobGroup> groups(jobs.size());
  std::vector<std::size_t> group_of(jobs.size());
  std::map<std::string, std::size_t> user_of;  // by list: its first job
  const auto join = [&](std::size_t a, std::size_t b) {
    if (a == b) return;
    if (b < a) std::swap(a, b);
    for (const std::size_t job : groups[b]) group_of[job] = a;
    groups[a].insert(groups[a].end(), groups[b].begin(), groups[b].end());
    groups[b].clear();
  };
  for (std::size_t job = 0; job < jobs.size(); ++job) {
    groups[job] = {job};
    group_of[job] = job;
    for (const std::string& list : jobs[job].shared_lists)
      join(group_of[user_of.emplace(list, job).first->second], group_of[job]);
  }
  std::erase_if(groups, [](const JobGroup& group) { return group.empty(); });
  return groups;
}

}  // namespace

BatchJobs all_jobs(const Batch& batch) {
  BatchJobs jobs;
  for (const BatchJob& job : batch.jobs) jobs.push_back(&job);
  return jobs;
}

std::vector<BatchJobs> jobs_by_shard(const Batch& batch, int shards) {
  const std::vector<JobGroup> groups = groups_of(batch.jobs);
  std::vector<double> work;
  for (const JobGroup& group : groups) {
    work.push_back(0);
    for (const std::size_t job : group) work.back() += batch.jobs[job].work;
  }
  std::vector<BatchJobs> by_shard;
  for (const std::vector<std::size_t>& indices : plan_shards(work, shards)) {
    BatchJobs& jobs = by_shard.emplace_back();
    for (const std::size_t index : indices)
      for (const std::size_t job : groups[index]) jobs.push_back(&batch.jobs[job]);
    std::ranges::sort(jobs);  // in the order of the batch
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
