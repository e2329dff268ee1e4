#include "watch_claims.hpp"

#include <filesystem>
#include <set>

#include "watch_job.hpp"

namespace counterflex::cli {
namespace {

/// Of a file that need not be there yet.
std::string name_of_output(const std::string& path) {
  std::error_code ignored;
  const std::filesystem::path absolute = std::filesystem::absolute(path, ignored);
  const std::filesystem::path canonical = std::filesystem::weakly_canonical(absolute, ignored);
  return canonical.empty() ? path : canonical.native();
}

}  // namespace

std::vector<std::string> files_of_watch_job(const Options& job) {
  std::vector<std::string> files{watch_output(job)};
  if (job.report)
    for (const char* ending : {".json", ".csv", ".html"}) files.push_back(*job.report + ending);
  if (job.plot) files.push_back(*job.plot);
  return files;
}

std::optional<TakenOutput> OutputClaims::claim(const Options& job) {
  std::erase_if(owners_, [&](const auto& claimed) { return claimed.second == job.program; });
  std::set<std::string> claimed;
  for (const std::string& path : files_of_watch_job(job)) {
    const auto owner = owners_.find(name_of_output(path));
    std::error_code gone;
    if (owner != owners_.end() && std::filesystem::exists(owner->second, gone))
      return TakenOutput{path, owner->second};
    claimed.insert(name_of_output(path));
  }
  for (const std::string& name : claimed) owners_[name] = job.program;
  return std::nullopt;
}

}  // namespace counterflex::cli
