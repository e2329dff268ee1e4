#include "batch_units.hpp"

#include <fmt/format.h>

#include <utility>

#include "counterflex/files/files.hpp"
#include "job_process.hpp"

namespace counterflex::cli {
namespace {

constexpr double least_part = 1 << 19;  // of a program, for which it is worth being cut

BatchUnit unit_of(const BatchJob& job, const ShardUnit& which, const BatchFolder& folder) {
  BatchUnit unit{&job, which, {job.key, job.output}};
  if (!unit.is_part()) return unit;
  const std::string part = fmt::format("{}-{}-of-{}", which.job + 1, which.part + 1, which.parts);
  unit.kept = {sha256(job.key + part), folder.state("shards/" + part + ".part")};
  return unit;
}

/// The outcome of a unit, by whose output it is known.
JobOutcome named(JobOutcome outcome, const BatchUnit& unit) {
  outcome.key = unit.kept.key;
  outcome.output = unit.kept.output;
  return outcome;
}

}  // namespace

std::vector<BatchUnit> whole_jobs(const Batch& batch) {
  std::vector<BatchUnit> units;
  for (const BatchJob& job : batch.jobs) units.push_back({&job, {units.size()}, {job.key, job.output}});
  return units;
}

std::vector<std::vector<BatchUnit>> units_by_shard(const Batch& batch, int shards,
                                                   const BatchFolder& folder) {
  std::vector<double> work;
  for (const BatchJob& job : batch.jobs) work.push_back(job.work);
  std::vector<std::vector<BatchUnit>> by_shard;
  for (const auto& of_shard : plan_shards(work, shards, least_part)) {
    auto& units = by_shard.emplace_back();
    for (const ShardUnit& which : of_shard) units.push_back(unit_of(batch.jobs[which.job], which, folder));
  }
  return by_shard;
}

std::string plan_of(const Batch& batch) {
  std::string keys;
  for (const BatchJob& job : batch.jobs) keys += job.key + "\n";
  return sha256(keys);
}

std::string plan_of(const std::vector<std::vector<BatchUnit>>& units_by_shard) {
  std::string keys;
  for (const auto& units : units_by_shard) {
    for (const BatchUnit& unit : units) keys += unit.kept.key + "\n";
    keys += "\n";
  }
  return sha256(keys);
}

BatchTask task_of(const BatchUnit& unit) {
  const BatchJob& job = *unit.job;
  const auto lost = [&unit](int status) { return named(lost_outcome(*unit.job, status), unit); };
  if (!unit.is_part())
    return {job.work, [&job](int threads, const SendLine& send) { do_job(job, threads, send); }, lost};
  const auto record = [&unit](int threads, const SendLine& send) {
    BatchJob part = *unit.job;
    part.key = unit.kept.key;
    part.output = unit.kept.output;
    part.options.part = PartOfProgram{unit.which.part, unit.which.parts, unit.kept.output};
    do_job(part, threads, send);
  };
  return {job.work / unit.which.parts, record, lost};
}

BatchTask merging_task(const BatchJob& job, std::vector<std::string> records) {
  const auto merge = [&job, records](int threads, const SendLine& send) {
    BatchJob merged = job;
    merged.options.recorded = records;
    do_job(merged, threads, send);
  };
  return {job.work, merge, [&job](int status) { return lost_outcome(job, status); }};
}

std::optional<int> do_missing(const std::vector<BatchTask>& tasks, int threads, BatchManifest& manifest,
                              Console& console) {
  std::vector<BatchTask> missing;
  std::vector<std::size_t> units;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (manifest.outcome(i)) continue;
    units.push_back(i);
    missing.push_back(tasks[i]);
  }
  const AwaitedSignals signals;
  const auto ended = [&](std::size_t task, JobOutcome outcome) {
    manifest.set(units[task], std::move(outcome));
  };
  return run_tasks(missing, threads, signals, {ended, [&] { manifest.save_sometimes(); }}, console);
}

}  // namespace counterflex::cli
