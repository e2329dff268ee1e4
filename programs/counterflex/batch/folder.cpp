#include "batch/folder.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <utility>

#include "batch/globs.hpp"
#include "counterflex/files/file_writer.hpp"
#include "counterflex/files/files.hpp"

namespace counterflex::cli {
namespace {

namespace fs = std::filesystem;

std::string state_folder(const std::string& folder) {
  return (fs::path(folder) / ".counterflex").generic_string();
}

/// All folders that results are written to. Each has one name, so that a run does not wait for its own lock.
std::set<std::string> make_folders_of(const Batch& batch) {
  std::set<std::string> folders{batch.folder};
  for (const BatchJob& job : batch.jobs)
    for (const std::string& file : files_written(job)) folders.insert(folder_of(file));
  std::set<std::string> canonical;
  for (const std::string& folder : folders) {
    make_folder(folder);
    canonical.insert(fs::canonical(folder).generic_string());
  }
  return canonical;
}

}  // namespace

BatchFolder::BatchFolder(const Batch& batch, Use use, Console& console)
    : folder_(batch.folder), alone_(use == Use::alone) {
  const LockKind kind = alone_ ? LockKind::exclusive : LockKind::shared;
  for (const std::string& folder : make_folders_of(batch)) {
    locks_.emplace_back(folder, kind, "counterflex batch");
    if (locks_.back().locked()) continue;
    console.warning(
        folder, 0,
        fmt::format("its file system has no locks ({}): a second run in this folder is not refused",
                    locks_.back().why_not()));
    alone_ = false;
  }
  for (const char* name : {"manifest.json", "../summary.json", "../summary.csv"})
    outputs_.push_back(state(name));
  for (const BatchJob& job : batch.jobs)
    for (std::string& file : files_written(job)) outputs_.push_back(std::move(file));
  sweep();
}

void BatchFolder::make_state(const std::string& name) const {
  make_folder(state(name));
}

std::string BatchFolder::state(const std::string& name) const {
  return (fs::path(state_folder(folder_)) / name).lexically_normal().generic_string();
}

std::vector<std::string> BatchFolder::manifests() const {
  std::vector<std::string> files{state("manifest.json")};
  for (const std::string& file : files_matching(state("shards/*.json"))) files.push_back(file);
  return files;
}

void BatchFolder::sweep() const {
  if (alone_) sweep_temporaries(outputs_);
}

}  // namespace counterflex::cli
