#include "batch_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "counterflex/files/folders.hpp"
#include "counterflex/files/temporaries.hpp"

namespace counterflex::cli {
namespace {

namespace fs = std::filesystem;

std::string state_folder(const std::string& folder) {
  return (fs::path(folder) / ".counterflex").native();
}

/// That of the batch, and those outside of it that jobs write to.
std::set<std::string> folders_of(const Batch& batch) {
  const fs::path own = fs::path(batch.folder).lexically_normal();
  std::set<std::string> folders{batch.folder};
  for (const BatchJob& job : batch.jobs) {
    const fs::path folder = folder_of(job.output);
    const fs::path inside = folder.lexically_normal().lexically_relative(own);
    if (inside.empty() || inside.begin()->native() == "..") folders.insert(folder.native());
  }
  return folders;
}

/// All that a job may be writing when it is killed.
void add_outputs(const BatchJob& job, std::vector<std::string>& outputs) {
  outputs.push_back(job.output);
  if (job.options.report)
    for (const char* ending : {".json", ".csv", ".html"}) outputs.push_back(*job.options.report + ending);
  if (job.options.plot) outputs.push_back(*job.options.plot);
}

}  // namespace

BatchFolder::BatchFolder(const Batch& batch, Use use, Console& console)
    : folder_(batch.folder), alone_(use == Use::alone) {
  const LockKind kind = alone_ ? LockKind::exclusive : LockKind::shared;
  for (const std::string& folder : folders_of(batch)) {
    locks_.emplace_back(folder, kind, "counterflex batch");
    if (locks_.back().locked()) continue;
    console.warning(folder, 0,
                    fmt::format("its file system has no locks ({}): nothing keeps a second run away",
                                locks_.back().why_not()));
    alone_ = false;
  }
  for (const char* name : {"manifest.json", "../summary.json", "../summary.csv"})
    outputs_.push_back(state(name));
  for (const BatchJob& job : batch.jobs) add_outputs(job, outputs_);
  sweep();
}

void BatchFolder::make_state(const std::string& name) const {
  make_folder(state(name));
}

std::string BatchFolder::state(const std::string& name) const {
  return (fs::path(state_folder(folder_)) / name).lexically_normal().native();
}

std::vector<std::string> BatchFolder::manifests() const {
  std::vector<std::string> files{state("manifest.json")};
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(state("shards"), missing))
    if (entry.path().extension() == ".json") files.push_back(entry.path().native());
  std::sort(files.begin(), files.end());
  return files;
}

void BatchFolder::sweep() const {
  if (alone_) sweep_temporaries(outputs_);
}

}  // namespace counterflex::cli
