#include "batch/jobs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "batch/globs.hpp"
#include "counterflex/files/files.hpp"
#include "counterflex/program/program_files.hpp"
#include "counterflex/settings/environment.hpp"
#include "counterflex/settings/jobs_file.hpp"
#include "counterflex/settings/project_file.hpp"
#include "process/terminal.hpp"
#include "process/version.hpp"
#include "run/header/corrected_header.hpp"
#include "run/inputs.hpp"
#include "run/output_paths.hpp"
#include "settings/layers.hpp"
#include "settings/setting_options.hpp"

namespace counterflex::cli {
namespace {

namespace fs = std::filesystem;

/// Bytes of the program plus a constant for the start, weighted by method and causes. Affects only the order
/// of jobs and their assignment to shards.
double work_of(const BatchJob& job) {
  constexpr double beginning = 4096, causes = 2.5, nested = 500;
  std::error_code missing;
  const auto bytes = fs::file_size(job.program, missing);
  double work = beginning + (missing ? 0.0 : static_cast<double>(bytes));
  if (job.options.report || job.options.plot) work *= causes;
  if (job.options.method == Method::nested) work *= nested;
  return work;
}

/// The data lists that a job writes only if they change.
std::vector<std::string> lists_if_changed(const BatchJob& job) {
  std::vector<std::string> lists;
  const std::vector<std::string> read = files_of_program(job.program, job.options.data_lists);
  for (std::size_t i = 1; i < read.size(); ++i)
    if (!belongs_to_control(read[i]) && !is_same_file(read[i], data_list_beside(job.program)))
      lists.push_back(corrected_list(read[i], job.program, job.output));
  return lists;
}

/// The jobs found so far, and their files; the outputs must differ.
class JobList {
 public:
  JobList(const JobsFile& file, const std::vector<Setting>& environment, const Options& whole)
      : file_(file), environment_(environment), whole_(whole) {}

  Batch take() {
    for (const JobEntry& entry : file_.jobs)
      for (const std::string& pattern : entry.programs) add_all(pattern, entry);
    refuse_shared_files();
    std::vector<BatchJob> jobs;
    for (FoundJob& found : found_) jobs.push_back(std::move(found.job));
    return {file_.output,   std::move(jobs),        std::move(files_),
            whole_.threads, whole_.force_overwrite, std::move(remarks_)};
  }

 private:
  struct FoundJob {
    BatchJob job;
    Location where;
  };

  void add_all(const std::string& pattern, const JobEntry& entry) {
    std::error_code ignored;
    const fs::file_status found = fs::status(pattern, ignored);
    if (fs::exists(found) && !fs::is_regular_file(found))
      throw InputError(ErrorKind::machine_or_force, entry.where,
                       fmt::format("'{}' is not a program file", pattern));
    if (!is_glob(pattern) || fs::exists(found)) return add(pattern, entry);
    std::vector<std::string> programs = files_matching(pattern);
    std::erase_if(programs, has_corrected_header);
    if (programs.empty())
      throw InputError(ErrorKind::machine_or_force, entry.where,
                       fmt::format("no uncorrected program matches '{}'", pattern));
    for (const std::string& program : programs) add(program, entry);
  }

  void add(const std::string& program, const JobEntry& entry) {
    const Layers layers{entry.settings, file_.defaults, environment_, project_settings(program)};
    BatchJob job;
    job.program = program;
    job.options = options_for(program, layers, entry);
    job.options.project_file = find_project_file(program).value_or("");
    job.options.force_overwrite = job.options.force_overwrite || whole_.force_overwrite;
    job.output = *job.options.output;
    for (const std::string& list : lists_if_changed(job)) job.shared_lists.push_back(canonical_name(list));
    job.key = key_of(layers, job);
    for (SettingRemark& remark : remarks_on_replaced(Command::compensate, layers)) {
      const auto is_same = [&](const SettingRemark& known) {
        return known.what == remark.what && known.where.line == remark.where.line;
      };
      if (std::ranges::none_of(remarks_, is_same)) remarks_.push_back(std::move(remark));
    }
    job.work = work_of(job);
    for (const std::string& file : inputs_of(job.options))
      if (file == "-")
        throw InputError(ErrorKind::machine_or_force, entry.where,
                         fmt::format("{}: a job cannot read standard input (-); name a file", program));
    found_.push_back({std::move(job), entry.where});
  }

  /// A missing machine is an error of the jobs file.
  static Options options_for(const std::string& program, const Layers& layers, const JobEntry& entry) {
    try {
      return options_of(Command::compensate, layers, program);
    } catch (const InputError& error) {
      if (!error.where().file.empty()) throw;
      throw InputError(ErrorKind::machine_or_force, entry.where,
                       fmt::format("{}: {}", program, message_without_place(error)));
    }
  }

  /// Programs of one folder have one project file.
  const std::vector<Setting>& project_settings(const std::string& program) {
    const auto file = find_project_file(program);
    if (!file) return none_;
    const auto [found, is_new] = projects_.try_emplace(*file);
    if (is_new) found->second = read_project(read_input(*file, ErrorKind::machine_or_force), *file);
    return found->second;
  }

  void refuse_shared_files() {
    std::set<std::string> summaries, programs;
    for (const char* name : {"/summary.json", "/summary.csv"})
      summaries.insert(canonical_name(file_.output + name));
    for (const FoundJob& found : found_)
      for (const std::string& path : inputs_of(found.job.options)) files_.add_input(path);
    for (const FoundJob& found : found_) {
      for (const std::string& path : files_written(found.job)) {
        if (files_.is_input(path))
          refuse(found, path, "an input of this batch, and inputs are never overwritten");
        if (summaries.contains(canonical_name(path))) refuse(found, path, "the summary of the batch");
      }
      bool is_shared = !programs.insert(found.job.output).second;
      for (const std::string& path : outputs_of(found.job)) {
        is_shared = is_shared || files_.add_output(path, {found.job.output, found.job.program}) != nullptr;
        if (is_shared)
          refuse(found, path,
                 "which is also the output of another job: give one of them another folder or name");
      }
    }
  }

  [[noreturn]] static void refuse(const FoundJob& found, const std::string& path, const std::string& why) {
    throw InputError(ErrorKind::machine_or_force, found.where,
                     fmt::format("the output of {} would be {}, {}", found.job.program, path, why));
  }

  const JobsFile& file_;
  const std::vector<Setting>& environment_;
  const Options& whole_;  ///< settings of the whole batch
  const std::vector<Setting> none_{};
  std::map<std::string, std::vector<Setting>> projects_;
  std::vector<FoundJob> found_;
  std::vector<SettingRemark> remarks_;
  JobFiles files_;
};

}  // namespace

std::string key_of(const Layers& layers, const BatchJob& job) {
  std::string all = fmt::format("counterflex {}\n{}\n{}\n", version, job.program, job.output);
  for (const Setting& setting : effective_settings(Command::compensate, layers)) {
    if (setting.option == "threads" || setting.option == "output" || setting.option == "force-overwrite")
      continue;
    all += setting.option + '\n';
    for (const std::string& value : setting.values) all += value + '\n';
  }
  const std::vector<std::string> files = files_of_program(job.program, job.options.data_lists);
  for (std::size_t i = 1; i < files.size(); ++i) all += files[i] + '\n';
  return sha256(all);
}

std::vector<std::string> outputs_of(const BatchJob& job) {
  std::vector<std::string> files{job.output};
  if (const std::string list = data_list_beside(job.program); !list.empty())
    files.push_back(corrected_list(list, job.program, job.output));
  if (job.options.report)
    for (const char* ending : {".html", ".json", ".csv"}) files.push_back(*job.options.report + ending);
  if (job.options.plot) files.push_back(*job.options.plot);
  return files;
}

std::vector<std::string> files_written(const BatchJob& job) {
  std::vector<std::string> files = outputs_of(job);
  for (std::string& list : lists_if_changed(job)) files.push_back(std::move(list));
  return files;
}

Batch read_batch(const std::string& file, const std::string& from, const std::vector<Setting>& flags) {
  const JobsFile jobs_file = read_jobs(read_input(file, ErrorKind::machine_or_force), file);
  const std::vector<Setting> environment = read_environment(environment_variables(), from);
  Options whole;
  whole.command = Command::batch;
  whole = with_settings(std::move(whole), {flags, environment, jobs_file.defaults});
  return JobList(jobs_file, environment, whole).take();
}

}  // namespace counterflex::cli
