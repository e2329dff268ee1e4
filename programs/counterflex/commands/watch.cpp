#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>
#include <utility>

#include "batch/job_process.hpp"
#include "batch/jobs.hpp"
#include "batch/watch_record.hpp"
#include "batch/watched_files.hpp"
#include "commands/commands.hpp"
#include "counterflex/batch/folder_lock.hpp"
#include "counterflex/files/file_writer.hpp"
#include "counterflex/files/input_error.hpp"
#include "counterflex/files/text.hpp"
#include "process/console.hpp"
#include "process/exit_status.hpp"
#include "process/signals.hpp"
#include "process/standard_output.hpp"
#include "run/header/corrected_header.hpp"
#include "run/inputs.hpp"
#include "run/output_paths.hpp"
#include "settings/layers.hpp"
#include "settings/output_names.hpp"

namespace counterflex::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds between_polls{1};
constexpr std::chrono::seconds retry_after{30};  // after failed input or output
constexpr int patience_ms = 700;                 // for a job after SIGTERM
constexpr int hesitation_ms = 100;               // until a signal that ended a job arrives here, too

/// The job `compensate` for `program`. Throws `InputError` for wrong settings.
BatchJob job_for(const Options& watch, const std::string& program) {
  BatchJob job;
  job.program = program;
  const ProgramLayers found = layers_of(watch.sources, program);
  job.options = options_of(Command::compensate, found.layers, program);
  job.options.project_file = found.project_file;
  job.options.quiet = watch.quiet;
  job.options.verbose = watch.verbose;
  job.output = job.options.output.value_or(default_output(program));
  job.key = key_of(found.layers, job);
  return job;
}

[[noreturn]] void refuse_shared(const char* option, const std::string& path) {
  throw InputError(ErrorKind::usage, {},
                   fmt::format("{} of every program would be {}; give a folder that ends in /, or a pattern "
                               "such as {{name}}_CF{{ext}}",
                               option, path));
}

/// Throws if outputs of different programs are one file, or replace the program.
void refuse_shared_outputs(const Options& watch) {
  const BatchJob one = job_for(watch, (fs::path(watch.watch.folder) / "one.nc").generic_string());
  const BatchJob other = job_for(watch, (fs::path(watch.watch.folder) / "other.nc").generic_string());
  if (one.output == other.output) refuse_shared("--output", one.output);
  if (one.options.report && one.options.report == other.options.report)
    refuse_shared("--report", *one.options.report);
  if (one.options.plot && one.options.plot == other.options.plot) refuse_shared("--plot", *one.options.plot);
  if (canonical_name(one.output) == canonical_name(one.program))
    throw InputError(ErrorKind::usage, {watch.watch.folder},
                     "corrected programs would replace their originals: give another folder with --output");
}

/// Reports errors that affect every program before the first one appears.
void check_watch(const Options& options) {
  std::vector<std::string> read = options.forces;
  read.insert(read.end(), options.data_lists.begin(), options.data_lists.end());
  read.push_back(options.machine);
  if (options.tool_table) read.push_back(*options.tool_table);
  if (std::ranges::find(read, "-") != read.end())
    throw InputError(ErrorKind::usage, {},
                     "standard input (-) can be read only once, not for every program of a folder");
  refuse_shared_outputs(options);
  const MachineInput machine = read_machine_input(options);
  read_tool_lengths(options, &machine.machine);
  read_force_input(options);
}

nlohmann::ordered_json or_null(const std::optional<double>& number) {
  return number ? nlohmann::ordered_json(*number) : nlohmann::ordered_json();
}

std::string json_line(const JobOutcome& outcome) {
  const nlohmann::ordered_json line{{"program", outcome.program},
                                    {"output", outcome.output},
                                    {"exit", exit_number(outcome.error_kind)},
                                    {"verdict", outcome.verdict},
                                    {"verdict_reason", outcome.verdict_reason},
                                    {"error", outcome.error},
                                    {"before_mm", or_null(outcome.before_mm)},
                                    {"after_mm", or_null(outcome.after_mm)}};
  return line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string mm_text(const std::optional<double>& value, int decimals) {
  return value ? fmt::format("{:.{}f} mm", *value, decimals) : "-";
}

std::string text_line(const JobOutcome& outcome) {
  const std::string reason =
      outcome.verdict_reason.empty() ? "" : fmt::format(" ({})", outcome.verdict_reason);
  const std::string begin =
      fmt::format("{}{}: {}", outcome.verdict, reason, without_controls(outcome.program));
  if (outcome.error_kind)
    return fmt::format("{}: not written (exit status {})\n", begin, exit_number(outcome.error_kind));
  return fmt::format("{} -> {}: {} before, {} after\n", begin, without_controls(outcome.output),
                     mm_text(outcome.before_mm, 3), mm_text(outcome.after_mm, 4));
}

/// Runs the job in its own process. A signal ends that process, and then this one.
JobOutcome outcome_of_process(const BatchJob& job) {
  const AwaitedSignals signals;
  Workers workers;
  const JobOrder order{job.program, job.options.threads};
  workers.start(0, order.text(), [&](const SendLine& send) { do_job(job, order, send); });
  std::optional<JobOutcome> outcome;
  while (workers.running() > 0) {
    for (const WorkerEvent& event : workers.wait(&signals, -1)) {
      if (auto sent = news_of(event.line).outcome) outcome = std::move(sent);
      if (event.end && !outcome) outcome = lost_outcome(job, *event.end);
    }
    const bool is_lost = workers.running() == 0 && outcome->error_kind.has_value();
    const auto signal = signals.take(is_lost ? hesitation_ms : 0);
    if (!signal) continue;
    workers.end_all(patience_ms);
    sweep_abandoned(files_written(job));
    end_by(*signal);
  }
  sweep_abandoned(files_written(job));
  return *outcome;
}

/// Compensates one program at a time. Between jobs a signal ends the process at once.
class Watch {
 public:
  Watch(const Options& options, Console& console)
      : options_(options),
        console_(console),
        files_(options.watch.folder, options.watch.patterns),
        lock_(options.watch.folder, LockKind::exclusive, "counterflex watch"),
        record_(options.watch.folder) {
    if (!lock_.locked())
      console.warning(
          options.watch.folder, 0,
          fmt::format("its file system has no locks ({}): a second watch is not refused", lock_.why_not()));
    for (const auto& [program, outcome] : record_.programs())
      for (const FileHash& file : outcome.outputs) owners_[file.path] = {outcome.output, program};
  }

  /// Returns the kind of the first error.
  std::optional<ErrorKind> run() {
    files_.poll();
    do {
      std::this_thread::sleep_for(between_polls);
      files_.poll();
      for (const std::string& path : due()) compensate(path);
    } while (!options_.watch.once);
    for (const std::string& path : files_.changing())
      console_.note(path + ": it is being written; the next poll checks again\n");
    return first_failure_;
  }

 private:
  /// Complete programs that are not done, and failed ones that may succeed now.
  std::vector<std::string> due() {
    std::vector<std::string> due;
    FileHashes on_disk;
    for (const std::string& path : files_.complete()) {
      retries_.erase(path);
      if (is_own(path) || is_done(path, on_disk))
        files_.set_done(path);
      else
        due.push_back(path);
    }
    for (const auto& [path, time] : retries_)
      if (files_.contains(path) && Clock::now() >= time) due.push_back(path);
    return due;
  }

  /// Whether the watch wrote it. A corrected program is recognised by its header, without -o also by its
  /// name.
  bool is_own(const std::string& path) const {
    const bool named_so = !options_.output && fs::path(path).stem().extension() == ".comp";
    return named_so || has_corrected_header(path);
  }

  /// Whether an earlier watch compensated it. Wrong settings are reported when the program starts.
  bool is_done(const std::string& path, FileHashes& on_disk) {
    if (!files_.is_from_start(path)) return false;
    try {
      const BatchJob job = job_for(options_, path);
      if (!record_.is_done(job, on_disk)) return false;
      claim_outputs(job);
      return true;
    } catch (const InputError&) {
      return false;
    }
  }

  /// Whether a file belongs to another program, which is still there.
  static bool is_of_other(const OutputOwner& owner, const std::string& program) {
    std::error_code ignored;
    return owner.program != program && fs::exists(owner.program, ignored);
  }

  /// Throws `InputError` (ErrorKind::usage) if another program of the folder has one of the outputs.
  void claim_outputs(const BatchJob& job) {
    for (const std::string& file : outputs_of(job)) {
      const auto owner = owners_.find(canonical_name(file));
      if (owner == owners_.end() || !is_of_other(owner->second, job.program)) continue;
      throw InputError(ErrorKind::usage, {job.program},
                       fmt::format("its output would be {}, which is also the output of {}: give one of them "
                                   "another name, or name outputs with {{name}}{{ext}}",
                                   file, owner->second.program));
    }
    set_outputs(job, outputs_of(job));
  }

  void set_outputs(const BatchJob& job, const std::vector<std::string>& files) {
    for (const std::string& file : files) owners_[canonical_name(file)] = {job.output, job.program};
  }

  /// The outputs of a job that has ended, with its parts and lists.
  void set_written(const BatchJob& job, const JobOutcome& outcome) {
    if (outcome.error_kind) return;
    std::erase_if(owners_, [&](const auto& owned) { return owned.second.program == job.program; });
    set_outputs(job, outputs_of(job));
    for (const FileHash& file : outcome.outputs) set_outputs(job, {file.path});
    record_.set(job.program, outcome);
  }

  /// The programs of the folder, and the outputs of the others that have been compensated.
  JobFiles job_files(const std::string& program) const {
    JobFiles files;
    for (const std::string& path : files_.all())
      if (!is_own(path)) files.add_input(path);
    for (const auto& [file, owner] : owners_)
      if (is_of_other(owner, program)) files.add_output(file, owner);
    return files;
  }

  void compensate(const std::string& path) {
    files_.set_done(path);
    JobOutcome outcome;
    outcome.program = path;
    try {
      BatchJob job = job_for(options_, path);
      claim_outputs(job);
      const JobFiles files = job_files(path);
      job.options.job_files = &files;
      outcome = outcome_of_process(job);
      set_written(job, outcome);
    } catch (const InputError& wrong) {
      outcome.error_kind = wrong.kind();
      outcome.error = wrong.what();
    }
    const bool may_pass = outcome.error_kind == ErrorKind::transient_io;
    const bool is_reported = may_pass && retries_.contains(path);
    retries_.erase(path);
    if (may_pass) retries_[path] = Clock::now() + retry_after;
    if (!is_reported) report(outcome);
  }

  void report(const JobOutcome& outcome) {
    if (!first_failure_) first_failure_ = outcome.error_kind;
    if (!outcome.error.empty()) console_.error(outcome.error);
    if (options_.json || !options_.quiet)
      write_result(options_.json ? json_line(outcome) : text_line(outcome));
    std::error_code ignored;
    if (outcome.error_kind && fs::is_regular_file(outcome.output, ignored))
      console_.warning(outcome.output, 0,
                       fmt::format("not updated: compensation of {} failed", outcome.program));
    console_.finish_warnings();
  }

  const Options& options_;
  Console& console_;
  WatchedFiles files_;
  FolderLock lock_;
  WatchRecord record_;
  std::map<std::string, OutputOwner> owners_;  ///< by canonical name of an output
  std::map<std::string, Clock::time_point>
      retries_;  ///< failed programs that may succeed later, and when to try again
  std::optional<ErrorKind> first_failure_;
};

}  // namespace

std::optional<ErrorKind> run_watch(const Options& options, Console& console) {
  const auto do_one = [&](const std::string& text, const SendLine& send) {
    const JobOrder order = order_of(text);
    do_job(job_for(options, order.key), order, send);
  };
  if (do_ordered(do_one)) return std::nullopt;
  check_watch(options);
  Watch watch(options, console);
  if (!options.watch.once) console.detail(fmt::format("watching {}", options.watch.folder));
  return watch.run();
}

}  // namespace counterflex::cli
