#include "batch/watched_files.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <initializer_list>
#include <utility>

#include "counterflex/files/input_error.hpp"
#include "counterflex/files/system.hpp"
#include "counterflex/program/program_files.hpp"

namespace counterflex::cli {
namespace {

namespace fs = std::filesystem;

/// Ignores case.
bool ends_with_any(const std::string& name, std::initializer_list<std::string_view> endings) {
  std::string lower = name;
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::ranges::any_of(endings, [&](std::string_view end) { return lower.ends_with(end); });
}

bool is_hidden_or_temporary(const std::string& name) {
  return name.starts_with('.') || name.starts_with('#') || name.starts_with("~$") ||
         ends_with_any(name, {"~", ".tmp", ".temp", ".part", ".partial", ".filepart", ".crdownload", ".swp",
                              ".bak", ".lock"});
}

bool may_be_program(const std::string& name, const std::vector<std::string>& patterns) {
  if (is_hidden_or_temporary(name)) return false;
  if (patterns.empty()) return !ends_with_any(name, {".toml", ".csv", ".json", ".html", ".svg"});
  return std::ranges::any_of(patterns,
                             [&](const std::string& pattern) { return system::matches(pattern, name); });
}

/// Empty if there is no file, or an empty one.
std::optional<FileVersion> version_of(const std::string& path) {
  const auto facts = system::facts_of(path);
  if (!facts || facts->kind != system::FileKind::file || facts->size == 0) return std::nullopt;
  return FileVersion{facts->device, facts->inode, facts->size, facts->written_ns, facts->changed_ns};
}

}  // namespace

WatchedFiles::WatchedFiles(std::string folder, std::vector<std::string> patterns)
    : folder_(std::move(folder)), patterns_(std::move(patterns)) {
  std::error_code error;
  if (fs::is_directory(folder_, error)) return;
  throw InputError(ErrorKind::usage, {folder_},
                   "cannot watch the folder: " + (error ? error.message() : "it is not a folder"));
}

void WatchedFiles::poll() {
  std::map<std::string, File> files;
  std::vector<std::string> lists;
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error)) {
    const std::string path = entry->path().generic_string();
    const std::string list = data_list_beside(path);
    if (!list.empty()) lists.push_back(list);
    if (!may_be_program(entry->path().filename().generic_string(), patterns_)) continue;
    const auto found = version_of(path);
    if (!found) continue;
    File& file = files[path] = {.version = *found, .list = version_of(list), .is_from_start = is_first_poll_};
    const auto before = files_.find(path);
    if (before == files_.end() || before->second.version != *found || before->second.list != file.list)
      continue;
    file = before->second;
    file.is_complete = true;
  }
  if (error)
    throw InputError(ErrorKind::transient_io, {folder_},
                     "cannot read the watched folder: " + error.message());
  for (const std::string& list : lists) files.erase(list);
  files_ = std::move(files);
  is_first_poll_ = false;
}

std::vector<std::string> WatchedFiles::all() const {
  std::vector<std::string> paths;
  for (const auto& [path, file] : files_) paths.push_back(path);
  return paths;
}

std::vector<std::string> WatchedFiles::undone(bool complete) const {
  std::vector<std::string> paths;
  for (const auto& [path, file] : files_)
    if (!file.is_done && file.is_complete == complete) paths.push_back(path);
  return paths;
}

}  // namespace counterflex::cli
