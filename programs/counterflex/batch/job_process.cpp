#include "batch/job_process.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "counterflex/files/input_error.hpp"
#include "process/exit_status.hpp"
#include "process/guarded.hpp"
#include "run/compensate.hpp"
#include "run/output_paths.hpp"
#include "run/run_end.hpp"
#include "run/run_files.hpp"

namespace counterflex::cli {
namespace {

constexpr std::string_view line_word = "line ", solved_word = "solved ", outcome_word = "outcome ";

void note_report(const Run& run, const RunEnd& end, const RunFiles& files, JobOutcome& outcome) {
  const RunReport& report = end.report;
  outcome.inputs.clear();  // those that were read, as they were read
  for (const InputFile& input : run.facts.inputs) outcome.inputs.push_back({input.path, input.sha256});
  outcome.outputs = files.published();
  if (report.before) outcome.before_mm = report.before->max_mm;
  if (report.after) outcome.after_mm = report.after->max_mm;
  outcome.corrected_percent = report.corrected_percent;
  outcome.verdict = to_string(report.verdict);
  outcome.verdict_reason = report.verdict_reason;
  outcome.warnings = report.warnings.count;
  outcome.moves = report.blocks.moves;
}

/// The inputs as they are now; without those that cannot be read.
std::vector<FileHash> hashes_of_inputs(const BatchJob& job) {
  FileHashes hashes;
  std::vector<FileHash> inputs;
  for (const std::string& path : inputs_of(job.options))
    if (const auto& hash = hashes.of(path)) inputs.push_back({path, *hash});
  return inputs;
}

/// Adds those of `inputs` that the outcome does not have.
void add_inputs(const std::vector<FileHash>& inputs, JobOutcome& outcome) {
  for (const FileHash& input : inputs)
    if (std::ranges::find(outcome.inputs, input.path, &FileHash::path) == outcome.inputs.end())
      outcome.inputs.push_back(input);
}

std::size_t count_of(std::string_view text) {
  std::size_t value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

/// "12 of 200" lines.
double share_of(std::string_view text) {
  const std::size_t blank = text.find(' ');
  const auto all = static_cast<double>(std::max<std::size_t>(1, count_of(text.substr(blank + 1))));
  return std::min(1.0, static_cast<double>(count_of(text.substr(0, blank))) / all);
}

/// Of the job in another folder, with its reports if it has some.
void write_into(const std::string& folder, Options& options) {
  const auto file = [&](const char* name) { return (std::filesystem::path(folder) / name).generic_string(); };
  options.output = file("program");
  options.job_files = nullptr;
  if (options.report) options.report = file("report");
  if (options.plot) options.plot = file("plot.svg");
}

}  // namespace

// No path of Windows has a '|', and no key.
std::string JobOrder::text() const {
  return fmt::format("{}|{}|{}", threads, folder, key);
}

JobOrder order_of(const std::string& text) {
  const std::size_t folder = text.find('|') + 1, key = text.find('|', folder) + 1;
  return {text.substr(key), static_cast<int>(count_of(text)), text.substr(folder, key - 1 - folder)};
}

void do_job(const BatchJob& job, const JobOrder& order, const SendLine& send) {
  JobOutcome outcome = outcome_for(job);
  const std::vector<FileHash> inputs_before = outcome.inputs;
  Options options = job.options;
  if (!order.folder.empty()) write_into(order.folder, options);
  options.hash_outputs = true;
  options.threads = std::min(order.threads, options.threads);
  Console console(
      {options.quiet, options.verbose},
      {.error =
           [&](std::string_view diagnostic) {
             if (outcome.error.empty()) outcome.error = with_file(std::string(diagnostic), job.program);
           },
       .solving = [&](int line, int lines) { send(fmt::format("{}{} {}", line_word, line, lines)); },
       .solved = [&](std::size_t waypoints) { send(fmt::format("{}{}", solved_word, waypoints)); }});
  outcome.error_kind = guarded(console, [&] {
    return compensate_program(options, console,
                              [&](const Run& run, const RunEnd& end, const RunFiles& files) {
                                note_report(run, end, files, outcome);
                                return print_failure(run, end.report, console);
                              });
  });
  // A failure is outdated when any input has changed: the run may have ended before it read all of them.
  if (outcome.error_kind) add_inputs(inputs_before, outcome);
  console.finish_warnings();
  send(fmt::format("{}{}", outcome_word, to_json_line(outcome, exit_number)));
}

JobNews news_of(std::string_view line) {
  const auto rest = [&](std::string_view word) { return line.substr(word.size()); };
  if (line.starts_with(line_word)) return {.done = share_of(rest(line_word))};
  if (line.starts_with(solved_word)) return {.waypoints = count_of(rest(solved_word))};
  if (line.starts_with(outcome_word)) return {.outcome = outcome_of(rest(outcome_word), exit_number)};
  return {};
}

JobOutcome outcome_for(const BatchJob& job) {
  JobOutcome outcome;
  outcome.key = job.key;
  outcome.program = job.program;
  outcome.output = job.output;
  outcome.inputs = hashes_of_inputs(job);
  return outcome;
}

JobOutcome lost_outcome(const BatchJob& job, const WorkerEnd& end) {
  JobOutcome outcome = outcome_for(job);
  outcome.error_kind = end.crashed ? ErrorKind::internal : ErrorKind::transient_io;
  outcome.error = fmt::format("{}: error: {}the process of this job {}", job.program,
                              end.crashed ? "internal error: " : "", end.text);
  return outcome;
}

}  // namespace counterflex::cli
