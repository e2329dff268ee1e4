#include "batch/manifest.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "counterflex/batch/manifest.hpp"
#include "counterflex/files/files.hpp"
#include "counterflex/files/input_error.hpp"
#include "process/exit_status.hpp"
#include "process/version.hpp"
#include "run/inputs.hpp"
#include "run/output_paths.hpp"

namespace counterflex::cli {
namespace {

constexpr std::chrono::milliseconds between_saves(500);

/// Outcomes in manifests of this version, by output.
std::multimap<std::string, JobOutcome> outcomes_in(const std::vector<std::string>& files) {
  std::multimap<std::string, JobOutcome> outcomes;
  for (const std::string& file : files) {
    std::error_code missing;
    if (!std::filesystem::exists(file, missing)) continue;
    Manifest manifest = read_manifest(read_input(file, ErrorKind::machine_or_force), file, exit_number);
    if (manifest.version != version) continue;
    for (JobOutcome& outcome : manifest.jobs) outcomes.emplace(outcome.output, std::move(outcome));
  }
  return outcomes;
}

}  // namespace

bool is_current(const JobOutcome& recorded, const BatchJob& job, FileHashes& on_disk) {
  if (!recorded.error_kind) return is_proven(recorded, job.key, on_disk);
  const auto is_as_recorded = [&](const FileHash& file) { return on_disk.of(file.path) == file.sha256; };
  const auto is_recorded_or_missing = [&](const std::string& path) {
    return !on_disk.of(path) ||
           std::ranges::find(recorded.inputs, path, &FileHash::path) != recorded.inputs.end();
  };
  return recorded.key == job.key && std::ranges::all_of(recorded.inputs, is_as_recorded) &&
         std::ranges::all_of(inputs_of(job.options), is_recorded_or_missing);
}

BatchManifest::BatchManifest(std::string path, std::string plan, BatchJobs jobs)
    : path_(std::move(path)), plan_(std::move(plan)), jobs_(std::move(jobs)), outcomes_(jobs_.size()) {}

std::vector<std::optional<JobOutcome>> BatchManifest::recorded(const std::vector<std::string>& files,
                                                               bool failed_too) const {
  const std::multimap<std::string, JobOutcome> by_output = outcomes_in(files);
  std::vector<std::optional<JobOutcome>> outcomes(jobs_.size());
  FileHashes on_disk;
  for (std::size_t i = 0; i < jobs_.size(); ++i) {
    const auto [begin, end] = by_output.equal_range(jobs_[i]->output);
    for (auto known = begin; known != end && !outcomes[i]; ++known) {
      const JobOutcome& outcome = known->second;
      const bool is_wanted = !outcome.error_kind || (failed_too && fails_again(*outcome.error_kind));
      if (is_wanted && is_current(outcome, *jobs_[i], on_disk)) outcomes[i] = outcome;
    }
  }
  return outcomes;
}

void BatchManifest::take_proven(const std::vector<std::string>& files) {
  outcomes_ = recorded(files, false);
}

bool BatchManifest::take_all_ended() {
  auto outcomes = recorded({path_}, true);
  const bool all =
      std::all_of(outcomes.begin(), outcomes.end(), [](const auto& outcome) { return outcome.has_value(); });
  if (all) outcomes_ = std::move(outcomes);
  return all;
}

void BatchManifest::set(std::size_t job, JobOutcome outcome) {
  outcomes_[job] = std::move(outcome);
  changed_ = true;
}

std::vector<JobOutcome> BatchManifest::ended() const {
  std::vector<JobOutcome> ended;
  for (const auto& outcome : outcomes_)
    if (outcome) ended.push_back(*outcome);
  return ended;
}

void BatchManifest::save_sometimes() {
  if (!changed_ || std::chrono::steady_clock::now() - saved_ < between_saves) return;
  try {
    save();
  } catch (const InputError&) {
    saved_ = std::chrono::steady_clock::now();  // the next save waits
  }
}

void BatchManifest::save() {
  if (!changed_) return;
  write_file(path_, to_text({version, plan_, ended()}, exit_number));
  changed_ = false;
  saved_ = std::chrono::steady_clock::now();
}

}  // namespace counterflex::cli
