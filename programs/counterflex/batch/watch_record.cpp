#include "batch/watch_record.hpp"

#include <algorithm>
#include <filesystem>

#include "counterflex/files/file_writer.hpp"
#include "counterflex/files/files.hpp"
#include "process/exit_status.hpp"
#include "process/version.hpp"
#include "run/header/corrected_header.hpp"
#include "run/inputs.hpp"
#include "run/job_files.hpp"

namespace counterflex::cli {

namespace fs = std::filesystem;

namespace {

Manifest read_record(const std::string& path) {
  const std::string text = read_input(path, ErrorKind::machine_or_force);
  try {
    return read_manifest(text, path, exit_number);
  } catch (const InputError&) {
    throw InputError(ErrorKind::machine_or_force, {path},
                     "the file is damaged; remove it: all programs of the folder are processed again");
  }
}

}  // namespace

WatchRecord::WatchRecord(const std::string& folder)
    : path_((fs::path(folder) / ".counterflex" / "watch.json").generic_string()) {
  std::error_code missing;
  if (!fs::exists(path_, missing)) return;
  Manifest manifest = read_record(path_);
  for (JobOutcome& outcome : manifest.jobs) {
    const std::string program = (fs::path(folder) / outcome.program).generic_string();
    programs_.emplace(program, std::move(outcome));
  }
}

bool WatchRecord::is_done(const BatchJob& job, FileHashes& on_disk) const {
  const auto found = programs_.find(job.program);
  if (found == programs_.end()) return false;
  JobOutcome recorded = found->second;
  // A corrected program that was edited by hand is kept.
  for (FileHash& file : recorded.outputs)
    if (file.path == recorded.output && has_corrected_header(file.path))
      file.sha256 = on_disk.of(file.path).value_or("");
  return is_proven(recorded, job.key, on_disk);
}

void WatchRecord::set(const std::string& program, JobOutcome outcome) {
  outcome.program = fs::path(program).filename().generic_string();
  outcome.output = canonical_name(outcome.output);
  for (FileHash& file : outcome.outputs) file.path = canonical_name(file.path);
  const auto is_taken = [&](const FileHash& file) {
    return std::ranges::find(outcome.outputs, file.path, &FileHash::path) != outcome.outputs.end();
  };
  std::erase_if(programs_, [&](const auto& known) {
    return known.first == program || known.second.output == outcome.output ||
           std::ranges::any_of(known.second.outputs, is_taken);
  });
  programs_.emplace(program, std::move(outcome));
  save();
}

void WatchRecord::save() const {
  Manifest manifest{.version = std::string(version), .plan = {}, .jobs = {}};
  for (const auto& [program, outcome] : programs_) manifest.jobs.push_back(outcome);
  make_folder(fs::path(path_).parent_path().generic_string());
  write_file(path_, to_text(manifest, exit_number));
}

}  // namespace counterflex::cli
