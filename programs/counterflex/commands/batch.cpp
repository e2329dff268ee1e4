#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <filesystem>

#include "batch/estimate.hpp"
#include "batch/folder.hpp"
#include "batch/job_process.hpp"
#include "batch/jobs.hpp"
#include "batch/manifest.hpp"
#include "batch/merge.hpp"
#include "batch/run.hpp"
#include "batch/shards.hpp"
#include "commands/commands.hpp"
#include "counterflex/batch/manifest.hpp"
#include "counterflex/files/file_writer.hpp"
#include "counterflex/files/files.hpp"
#include "counterflex/settings/project_file.hpp"
#include "process/exit_status.hpp"
#include "process/signals.hpp"
#include "process/standard_output.hpp"
#include "process/version.hpp"
#include "run/output_paths.hpp"
#include "run/run_files.hpp"

namespace counterflex::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t rows_shown = 30;

/// Paths of a jobs file, and those in reports, are relative to its folder. The working directory has no
/// effect.
std::string enter_folder_of(const std::string& file, Console& console) {
  if (file == "-")
    throw InputError(
        ErrorKind::usage, {},
        "the jobs file must be a file, not standard input: its paths are relative to its folder");
  refuse_special_file(file);
  const fs::path path(file);
  if (!path.has_parent_path()) return file;
  std::error_code error;
  fs::current_path(path.parent_path(), error);
  if (error)
    throw InputError(ErrorKind::machine_or_force, {file}, "cannot read the file: " + error.message());
  console.detail(fmt::format("in {}/", path.parent_path().generic_string()));
  return path.filename().generic_string();
}

void check_flags(const Options& options) {
  const int modes =
      (options.batch.merge ? 1 : 0) + (options.batch.shard ? 1 : 0) + (options.batch.estimate ? 1 : 0);
  if (modes > 1) throw InputError(ErrorKind::usage, {}, "--shard, --merge and --estimate exclude each other");
  if (options.batch.resume && (options.batch.merge || options.batch.estimate))
    throw InputError(ErrorKind::usage, {}, "--resume goes with a run or a --shard of it");
  if (options.json && (options.batch.shard || options.batch.estimate))
    throw InputError(
        ErrorKind::usage, {},
        fmt::format("--json goes with a run or --merge, which write the summary; {} prints one line "
                    "of text, leave --json out",
                    options.batch.shard ? "--shard" : "--estimate"));
}

/// Refuses to replace files that counterflex did not write. Called before any job starts.
void refuse_foreign_summary(const Batch& batch) {
  if (batch.force_overwrite) return;
  refuse_foreign({marked_file(batch.folder + "/summary.json", "\"counterflex-batch 1\""),
                  marked_file(batch.folder + "/summary.csv", summary_columns)});
}

void write_summary(const Batch& batch, const std::vector<JobOutcome>& outcomes, const std::string& json) {
  FileWriter json_file(batch.folder + "/summary.json"), csv_file(batch.folder + "/summary.csv");
  json_file.write(json);
  csv_file.write(summary_csv(outcomes, exit_number));
  publish_together({&json_file, &csv_file});
}

/// Removes the summary of an earlier run, so that it is not mistaken for the summary of this run.
void remove_summary(const Batch& batch) {
  for (const char* name : {"/summary.json", "/summary.csv"}) {
    std::error_code error;
    if (fs::remove(batch.folder + name, error); error)
      throw InputError(ErrorKind::transient_io, {batch.folder + name},
                       "cannot remove the file: " + error.message());
  }
}

/// Warns of corrected programs of earlier runs whose jobs failed in this run.
void warn_of_older(const std::vector<JobOutcome>& outcomes, Console& console) {
  std::error_code ignored;
  for (const JobOutcome& outcome : outcomes)
    if (outcome.error_kind && fs::exists(outcome.output, ignored))
      console.warning(outcome.output, 0,
                      fmt::format("not updated: compensation of {} failed", outcome.program));
}

/// Prints the table even if no file can be written, for example on a full disk.
std::optional<ErrorKind> conclude(const Options& options, const Batch& batch, BatchManifest& manifest,
                                  Console& console) {
  const std::vector<JobOutcome> outcomes = manifest.ended();
  const std::string json = summary_json(outcomes, version, exit_number);
  std::exception_ptr unsaved;
  try {
    manifest.save();
    refuse_foreign_summary(batch);  // that came to be during the run
    write_summary(batch, outcomes, json);
  } catch (const InputError&) {
    unsaved = std::current_exception();
  }
  warn_of_older(outcomes, console);
  console.finish_warnings();
  write_result(options.json ? json : summary_table(outcomes, rows_shown));
  if (unsaved) std::rethrow_exception(unsaved);
  return error_of(outcomes);
}

/// One line for scripts.
ExitStatus say_estimate(const Batch& batch) {
  write_result(fmt::format("work_s={:.1f} jobs={}\n", estimated_seconds(batch), batch.jobs.size()));
  return ExitStatus(std::nullopt);
}

/// Jobs that are unchanged since the last run.
void take_proven(const Options& options, const BatchFolder& folder, BatchManifest& manifest,
                 Console& console) {
  if (!options.batch.resume) return;
  manifest.take_proven(folder.manifests());
  console.detail(fmt::format("{} of {} are unchanged since the last run", manifest.ended().size(),
                             manifest.jobs().size()));
}

/// Keeps the results of a run that was stopped.
ExitStatus saved(BatchManifest& manifest, int signal) {
  manifest.save();
  return ExitStatus::of_signal(signal);
}

ExitStatus run_shard(const Options& options, Batch& batch, Console& console) {
  const auto [index, count] = *options.batch.shard;
  const BatchFolder folder(batch, BatchFolder::Use::shared, console);
  folder.make_state("shards");
  const std::vector<BatchJobs> by_shard = jobs_by_shard(batch, count);
  const BatchJobs& jobs = by_shard[static_cast<std::size_t>(index - 1)];
  BatchManifest manifest(shard_manifest(folder, index, count), plan_of(by_shard), jobs);
  take_proven(options, folder, manifest, console);
  const auto stopped = do_missing(manifest, batch.threads, batch.files, console);
  if (stopped) return saved(manifest, *stopped);
  manifest.save();
  const std::vector<JobOutcome> outcomes = manifest.ended();
  const auto failed = std::count_if(outcomes.begin(), outcomes.end(),
                                    [](const JobOutcome& o) { return o.error_kind.has_value(); });
  write_result(fmt::format("shard {} of {}: {} jobs, {} failed\n", index, count, jobs.size(), failed));
  return error_of(outcomes);
}

ExitStatus run_merge(const Options& options, const Batch& batch, Console& console) {
  const BatchFolder folder(batch, BatchFolder::Use::alone, console);
  BatchManifest manifest(folder.state("manifest.json"), plan_of({all_jobs(batch)}), all_jobs(batch));
  if (has_shards(folder)) remove_summary(batch);
  merge_shards(batch, folder, manifest);
  const auto error = conclude(options, batch, manifest, console);
  if (!error || fails_again(*error)) remove_shards(folder);  // otherwise the next try needs them
  return error;
}

ExitStatus run_all(const Options& options, Batch& batch, Console& console) {
  const BatchFolder folder(batch, BatchFolder::Use::alone, console);
  BatchManifest manifest(folder.state("manifest.json"), plan_of({all_jobs(batch)}), all_jobs(batch));
  take_proven(options, folder, manifest, console);
  remove_summary(batch);
  const auto stopped = do_missing(manifest, batch.threads, batch.files, console);
  folder.sweep();
  if (stopped) return saved(manifest, *stopped);
  const auto error = conclude(options, batch, manifest, console);
  remove_shards(folder);  // of an abandoned earlier try
  return error;
}

/// In a worker.
void do_one(const Batch& batch, const JobOrder& order, const SendLine& send) {
  const auto job = std::ranges::find(batch.jobs, order.key, &BatchJob::key);
  if (job != batch.jobs.end()) do_job(*job, order, send);
}

}  // namespace

ExitStatus run_batch(const Options& options, Console& console) {
  check_flags(options);
  std::error_code gone;
  const std::string from = fs::current_path(gone).generic_string();
  Batch batch = read_batch(enter_folder_of(options.batch.jobs, console), from, options.sources.flags);
  for (BatchJob& job : batch.jobs) {
    job.options.quiet = !options.verbose;  // the table shows the number of warnings
    job.options.job_files = &batch.files;
  }
  if (do_ordered(
          [&](const std::string& order, const SendLine& send) { do_one(batch, order_of(order), send); }))
    return ExitStatus(std::nullopt);
  for (const SettingRemark& remark : batch.remarks)
    console.warning(remark.where.file, remark.where.line, remark.what);
  if (options.batch.estimate) return say_estimate(batch);
  refuse_foreign_summary(batch);
  if (options.batch.shard) return run_shard(options, batch, console);
  return options.batch.merge ? run_merge(options, batch, console) : run_all(options, batch, console);
}

}  // namespace counterflex::cli
