#include <fmt/format.h>

#include <filesystem>
#include <numeric>

#include "batch_folder.hpp"
#include "batch_jobs.hpp"
#include "batch_manifest.hpp"
#include "batch_run.hpp"
#include "commands.hpp"
#include "counterflex/batch/summary.hpp"
#include "counterflex/files/file_writer.hpp"
#include "counterflex/files/files.hpp"
#include "job_process.hpp"
#include "outputs.hpp"
#include "version.hpp"

namespace counterflex::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t rows_shown = 30;

/// Paths of a jobs file, and so those in reports, are relative to its folder, from wherever it is called.
std::string enter_folder_of(const std::string& file, Console& console) {
  if (file == "-") throw InputError(Exit::usage, {}, "a jobs file has a folder, to which its paths are relative: not standard input");
  const fs::path path(file);
  if (!path.has_parent_path()) return file;
  std::error_code error;
  fs::current_path(path.parent_path(), error);
  if (error) throw InputError(Exit::machine_or_force, {file}, "cannot read the file: " + error.message());
  console.detail(fmt::format("in {}/", path.parent_path().native()));
  return path.filename().native();
}

void check_flags(const Options& options) {
  const int asked = (options.merge ? 1 : 0) + (options.shard ? 1 : 0) + (options.estimate ? 1 : 0);
  if (asked > 1) throw InputError(Exit::usage, {}, "--shard, --merge and --estimate exclude each other");
  if (options.resume && (options.merge || options.estimate))
    throw InputError(Exit::usage, {}, "--resume goes with a run or a --shard of it");
}

std::vector<KeptUnit> kept_units(const Batch& batch) {
  std::vector<KeptUnit> units;
  for (const BatchJob& job : batch.jobs) units.push_back({job.key, job.output});
  return units;
}

/// Of all jobs: their keys, in which everything is.
std::string plan_of(const Batch& batch) {
  std::string keys;
  for (const BatchJob& job : batch.jobs) keys += job.key + "\n";
  return sha256(keys);
}

BatchTask task_of(const BatchJob& job) {
  return {job.program, job.work,
          [&job](int threads, const SendLine& send) { do_job(job, threads, send); },
          [&job](int status) { return lost_outcome(job, status); }};
}

void write_summary(const Batch& batch, const std::vector<JobOutcome>& outcomes, const std::string& json) {
  FileWriter json_file(batch.folder + "/summary.json"), csv_file(batch.folder + "/summary.csv");
  json_file.write(json);
  csv_file.write(summary_csv(outcomes));
  publish_together({&json_file, &csv_file});
}

/// An older program under the name that a job which failed would have written is no correction of this one.
void warn_of_older(const std::vector<JobOutcome>& outcomes, Console& console) {
  std::error_code ignored;
  for (const JobOutcome& outcome : outcomes)
    if (outcome.exit != Exit::done && fs::exists(outcome.output, ignored))
      console.warning(outcome.output, 0, fmt::format("is of an earlier run: {} failed now", outcome.program));
}

Exit conclude(const Options& options, const Batch& batch, const std::vector<JobOutcome>& outcomes, Console& console) {
  const std::string json = summary_json(outcomes, version);
  write_summary(batch, outcomes, json);
  warn_of_older(outcomes, console);
  console.finish_warnings();
  write_result(options.json ? json : summary_table(outcomes, rows_shown));
  return exit_of(outcomes);
}

/// Does what the manifest does not hold yet. The signal that stopped it, if any.
std::optional<int> do_missing(const Options& options, const Batch& batch, const BatchFolder& folder, BatchManifest& manifest, Console& console) {
  std::vector<BatchTask> tasks;
  std::vector<std::size_t> units;
  for (std::size_t i = 0; i < batch.jobs.size(); ++i) {
    if (manifest.outcome(i)) continue;
    units.push_back(i);
    tasks.push_back(task_of(batch.jobs[i]));
  }
  const std::size_t proven = batch.jobs.size() - units.size();
  if (options.resume) console.detail(fmt::format("{} of {} jobs are proven done", proven, batch.jobs.size()));
  const AwaitedSignals signals;
  return run_tasks(tasks, options.threads, signals,
                   {.ended = [&](std::size_t task, JobOutcome outcome) { manifest.set(units[task], std::move(outcome)); },
                    .now_and_then = [&] { manifest.save_sometimes(); }},
                   console);
}

}  // namespace

Exit run_batch(const Options& options, Console& console) {
  check_flags(options);
  const Batch batch = read_batch(enter_folder_of(options.jobs, console));
  const BatchFolder folder(batch, BatchFolder::Use::alone, console);
  BatchManifest manifest(folder.state("manifest.json"), plan_of(batch), kept_units(batch));
  if (options.resume) manifest.take_proven();
  const auto stopped = do_missing(options, batch, folder, manifest, console);
  folder.sweep();
  manifest.save();
  if (stopped) return static_cast<Exit>(status_of(*stopped));
  return conclude(options, batch, manifest.ended(), console);
}

}  // namespace counterflex::cli
