#include "batch/merge.hpp"

#include <fmt/format.h>

#include <exception>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "batch/globs.hpp"
#include "batch/shards.hpp"
#include "counterflex/files/input_error.hpp"
#include "process/exit_status.hpp"
#include "process/version.hpp"
#include "run/inputs.hpp"

namespace counterflex::cli {
namespace {

namespace fs = std::filesystem;

/// The numbers N in names of shard manifests: "-of-N.json".
std::set<int> counts_of_shards(const BatchFolder& folder) {
  std::set<int> counts;
  for (const std::string& file : files_matching(folder.state("shards/*-of-*.json"))) {
    const std::string name = fs::path(file).stem().generic_string();
    const std::size_t of = name.find("-of-");
    try {
      counts.insert(read_shard(name.substr(0, of) + "/" + name.substr(of + 4)).count);
    } catch (const InputError&) {  // not the manifest of a shard
    }
  }
  return counts;
}

[[noreturn]] void refuse_shard(const std::string& path, int index, int count, const std::string& why) {
  throw InputError(ErrorKind::transient_io, {path},
                   fmt::format("{}; run --shard {}/{} --resume and merge again", why, index, count));
}

/// The outcomes of all jobs of `count` shards, by output. Throws `InputError` if one is missing or has
/// changed since its shard ended.
class ShardResults {
 public:
  ShardResults(const Batch& batch, const BatchFolder& folder, int count) : folder_(folder), count_(count) {
    const std::vector<BatchJobs> by_shard = jobs_by_shard(batch, count_);
    const std::string plan = plan_of(by_shard);
    for (int index = 1; index <= count_; ++index)
      read(index, plan, by_shard[static_cast<std::size_t>(index - 1)]);
  }

  const JobOutcome& outcome(const BatchJob& job) const { return outcomes_.at(job.output); }

 private:
  void read(int index, const std::string& plan, const BatchJobs& jobs) {
    const std::string path = shard_manifest(folder_, index, count_);
    std::error_code ignored;
    if (!fs::exists(path, ignored)) refuse_shard(path, index, count_, "this shard is missing");
    Manifest manifest = read_manifest(read_input(path, ErrorKind::machine_or_force), path, exit_number);
    if (manifest.plan != plan || manifest.version != version)
      refuse_shard(path, index, count_,
                   "this shard was done for other jobs, or for programs of another size");
    for (JobOutcome& outcome : manifest.jobs) outcomes_[outcome.output] = std::move(outcome);
    for (const BatchJob* job : jobs) check(*job, path, index);
  }

  void check(const BatchJob& job, const std::string& path, int index) {
    const auto found = outcomes_.find(job.output);
    if (found == outcomes_.end() || found->second.key != job.key)
      refuse_shard(path, index, count_, fmt::format("this shard has not come to {} yet", job.program));
    if (!is_current(found->second, job, on_disk_))
      refuse_shard(path, index, count_,
                   fmt::format("an input or an output of {} has been changed since", job.program));
  }

  const BatchFolder& folder_;
  int count_;
  std::map<std::string, JobOutcome> outcomes_;
  FileHashes on_disk_;
};

/// Of the shards in the state folder those that are complete: a batch may have been divided again.
ShardResults complete_results(const Batch& batch, const BatchFolder& folder) {
  std::exception_ptr incomplete;
  for (const int count : counts_of_shards(folder)) try {
      return ShardResults(batch, folder, count);
    } catch (const InputError&) {
      incomplete = std::current_exception();
    }
  if (incomplete) std::rethrow_exception(incomplete);
  throw InputError(ErrorKind::transient_io, {folder.state("shards")},
                   "no shard has been done here; run them with --shard");
}

}  // namespace

bool has_shards(const BatchFolder& folder) {
  return !counts_of_shards(folder).empty();
}

void merge_shards(const Batch& batch, const BatchFolder& folder, BatchManifest& manifest) {
  if (!has_shards(folder) && manifest.take_all_ended()) return;
  const ShardResults results = complete_results(batch, folder);
  for (std::size_t job = 0; job < batch.jobs.size(); ++job)
    manifest.set(job, results.outcome(batch.jobs[job]));
}

/// Renames the folder first, so that a partly removed set of shards is never taken for a complete one.
void remove_shards(const BatchFolder& folder) {
  const std::string merged = folder.state("merged");
  std::error_code ignored;
  fs::remove_all(merged, ignored);
  fs::rename(folder.state("shards"), merged, ignored);
  fs::remove_all(merged, ignored);
}

std::string shard_manifest(const BatchFolder& folder, int index, int count) {
  return folder.state(fmt::format("shards/{}-of-{}.json", index, count));
}

}  // namespace counterflex::cli
