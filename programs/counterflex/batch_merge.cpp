#include "batch_merge.hpp"

#include <fmt/format.h>

#include <exception>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "batch_units.hpp"
#include "counterflex/files/input_error.hpp"
#include "globs.hpp"
#include "inputs.hpp"
#include "version.hpp"

namespace counterflex::cli {
namespace {

namespace fs = std::filesystem;

/// Numbers that the names of the shards' manifests end in: "-of-N.json".
std::set<int> counts_of_shards(const BatchFolder& folder) {
  std::set<int> counts;
  for (const std::string& file : files_matching(folder.state("shards/*-of-*.json"))) {
    const std::string name = fs::path(file).stem().native();
    const std::size_t of = name.find("-of-");
    try {
      counts.insert(read_shard(name.substr(0, of) + "/" + name.substr(of + 4)).count);
    } catch (const InputError&) {  // no shard's
    }
  }
  return counts;
}

[[noreturn]] void refuse_shard(const std::string& path, int index, int count, const std::string& why) {
  throw InputError(Exit::transient_io, {path},
                   fmt::format("{}; run --shard {}/{} --resume and merge again", why, index, count));
}

/// What the shards have done, by unit's output.
class ShardResults {
 public:
  ShardResults(const Batch& batch, const BatchFolder& folder, int count)
      : folder_(folder), count_(count), units_(units_by_shard(batch, count_, folder)) {
    const std::string plan = plan_of(units_);
    for (int index = 1; index <= count_; ++index) read(index, plan);
  }

  const std::vector<std::vector<BatchUnit>>& units() const { return units_; }
  const JobOutcome& outcome(const BatchUnit& unit) const { return outcomes_.at(unit.kept.output); }

 private:
  void read(int index, const std::string& plan) {
    const std::string path = shard_manifest(folder_, index, count_);
    std::error_code ignored;
    if (!fs::exists(path, ignored)) refuse_shard(path, index, count_, "this shard is missing");
    Manifest manifest = read_manifest(read_input(path, Exit::machine_or_force), path);
    if (manifest.plan != plan || manifest.version != version)
      refuse_shard(path, index, count_,
                   "this shard was done for other jobs, or for programs of another size");
    for (JobOutcome& outcome : manifest.jobs) outcomes_[outcome.output] = std::move(outcome);
    for (const BatchUnit& unit : units_[static_cast<std::size_t>(index - 1)]) check(unit, path, index);
  }

  void check(const BatchUnit& unit, const std::string& path, int index) {
    const auto found = outcomes_.find(unit.kept.output);
    if (found == outcomes_.end() || found->second.key != unit.kept.key)
      refuse_shard(path, index, count_, fmt::format("this shard has not come to {} yet", unit.job->program));
    if (found->second.exit == Exit::done && !is_proven(found->second, unit.kept.key, on_disk_))
      refuse_shard(path, index, count_,
                   fmt::format("an input or an output of {} has been changed since", unit.job->program));
  }

  const BatchFolder& folder_;
  int count_;
  std::vector<std::vector<BatchUnit>> units_;
  std::map<std::string, JobOutcome> outcomes_;
  FileHashes on_disk_;
};

/// Of the shards that stand here, those that are complete: a batch may have been shared out anew.
ShardResults complete_results(const Batch& batch, const BatchFolder& folder) {
  std::exception_ptr incomplete;
  for (const int count : counts_of_shards(folder)) try {
      return ShardResults(batch, folder, count);
    } catch (const InputError&) {
      incomplete = std::current_exception();
    }
  if (incomplete) std::rethrow_exception(incomplete);
  throw InputError(Exit::transient_io, {folder.state("shards")},
                   "no shard has been done here; run them with --shard");
}

/// A program that was split: the files of its parts, or the outcome of a part that failed.
struct SplitJob {
  std::vector<std::string> records{};
  std::optional<JobOutcome> failed{};
};

std::map<std::size_t, SplitJob> split_jobs(const ShardResults& results) {
  std::map<std::size_t, SplitJob> split;
  for (const auto& units : results.units())
    for (const BatchUnit& unit : units) {
      if (!unit.is_part()) continue;
      const JobOutcome& outcome = results.outcome(unit);
      SplitJob& job = split[unit.which.job];
      job.records.push_back(unit.kept.output);
      if (outcome.exit != Exit::done) job.failed = outcome;
    }
  return split;
}

}  // namespace

bool has_shards(const BatchFolder& folder) {
  return !counts_of_shards(folder).empty();
}

std::optional<int> merge_shards(const Batch& batch, const BatchFolder& folder, int threads,
                                BatchManifest& manifest, Console& console) {
  if (!has_shards(folder) && manifest.take_all_ended()) return std::nullopt;
  const ShardResults results = complete_results(batch, folder);
  for (const auto& units : results.units())
    for (const BatchUnit& unit : units)
      if (!unit.is_part()) manifest.set(unit.which.job, results.outcome(unit));
  std::vector<BatchTask> tasks(batch.jobs.size());
  for (auto& [index, split] : split_jobs(results)) {
    const BatchJob& job = batch.jobs[index];
    tasks[index] = merging_task(job, std::move(split.records));
    if (!split.failed) continue;
    split.failed->key = job.key;
    split.failed->output = job.output;
    manifest.set(index, std::move(*split.failed));
  }
  return do_missing(tasks, threads, manifest, console);
}

/// First all of it gets another name: half of the shards must never look like all.
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
