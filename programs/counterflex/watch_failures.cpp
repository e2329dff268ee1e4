#include "watch_failures.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <utility>

namespace counterflex::cli {
namespace {

std::int64_t nanoseconds_of(const timespec& time) {
  constexpr std::int64_t per_second = 1'000'000'000;
  return std::int64_t{time.tv_sec} * per_second + time.tv_nsec;
}

std::optional<FileStamp> stamp_of(const std::string& path) {
  struct stat facts {};
  if (::stat(path.c_str(), &facts) != 0) return std::nullopt;
  return FileStamp{facts.st_dev, facts.st_ino, static_cast<std::uint64_t>(facts.st_size),
                   nanoseconds_of(facts.st_mtim), nanoseconds_of(facts.st_ctim)};
}

bool is_there(const std::string& path) {
  std::error_code error;
  return std::filesystem::exists(std::filesystem::symlink_status(path, error));
}

}  // namespace

FileStamps stamps_of(const std::vector<std::string>& paths) {
  FileStamps stamps;
  for (const std::string& path : paths) stamps.emplace(path, stamp_of(path));
  return stamps;
}

std::vector<std::string> files_with_settings(const Options& watch, const std::string& program) {
  if (watch.sources.config) return {*watch.sources.config};
  std::vector<std::string> files;
  std::error_code error;
  std::filesystem::path folder = std::filesystem::absolute(program, error).parent_path();
  for (; !watch.sources.no_config && !folder.empty(); folder = folder.parent_path()) {
    files.push_back((folder / "counterflex.toml").string());
    if (folder == folder.root_path()) break;
  }
  return files;
}

std::vector<std::string> files_beside_program(const Options& job) {
  std::vector<std::string> files = job.forces;
  files.push_back(job.machine);
  if (job.tool_table) files.push_back(*job.tool_table);
  return files;
}

void WatchFailures::add(const std::string& program, FileStamps seen, std::optional<Clock::duration> pause) {
  Failure& failure = failures_[program];
  failure.seen = std::move(seen);
  if (pause) failure.again = Clock::now() + *pause;
}

std::vector<std::string> WatchFailures::take_due() {
  FileStamps now;  // each file is looked at once, of however many programs it is
  const auto has_changed = [&](const auto& seen) {
    const auto [entry, is_new] = now.try_emplace(seen.first);
    if (is_new) entry->second = stamp_of(seen.first);
    return entry->second != seen.second;
  };
  std::vector<std::string> due;
  const auto time = Clock::now();
  for (auto failure = failures_.begin(); failure != failures_.end();) {
    const auto& [program, facts] = *failure;
    const bool here = is_there(program);
    const bool again = (facts.again && time >= *facts.again) ||
                       std::any_of(facts.seen.begin(), facts.seen.end(), has_changed);
    if (here && again) due.push_back(program);
    failure = here && !again ? std::next(failure) : failures_.erase(failure);
  }
  return due;
}

}  // namespace counterflex::cli
