#include "batch/globs.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>
#include <utility>

#include "counterflex/files/input_error.hpp"
#include "counterflex/files/system.hpp"

namespace counterflex::cli {
namespace {

namespace fs = std::filesystem;

/// Walks the folders that match the parts of a pattern, one part for each level.
class Walk {
 public:
  /// Removes repeated "**", which only cost time.
  explicit Walk(const fs::path& pattern) {
    for (const fs::path& part : pattern)
      if (part != "**" || parts_.empty() || parts_.back() != "**") parts_.push_back(part);
  }

  std::vector<std::string> run() {
    go({}, 0);
    return {found_.begin(), found_.end()};
  }

 private:
  void go(const fs::path& at, std::size_t part) {
    if (!visited_.emplace(at.generic_string(), part).second)
      return;  // already reached, if "**" occurs more than once
    if (part == parts_.size()) return take(at);
    const std::string name = parts_[part].generic_string();
    if (!is_glob(name)) return go(at / parts_[part], part + 1);
    const bool any_depth = name == "**";
    if (any_depth) go(at, part + 1);
    for (const fs::path& entry : names_in(at)) {
      if (!system::matches(any_depth ? "*" : name, entry.generic_string())) continue;
      std::error_code ignored;
      if (!any_depth)
        go(at / entry, part + 1);
      else if (fs::is_directory(fs::symlink_status(at / entry, ignored)))
        go(at / entry, part);
    }
  }

  /// Lists a folder completely before entering its subfolders, so that depth needs no open descriptors. A
  /// missing folder is empty. Throws for a folder that cannot be read: it might have programs.
  static std::vector<fs::path> names_in(const fs::path& folder) {
    const fs::path place = folder.empty() ? fs::path(".") : folder;
    std::vector<fs::path> names;
    std::error_code error;
    fs::directory_iterator entry(place, error);
    for (; !error && entry != fs::directory_iterator(); entry.increment(error))
      names.push_back(entry->path().filename());
    if (!error || error == std::errc::no_such_file_or_directory || error == std::errc::not_a_directory)
      return names;
    const bool for_good = error == std::errc::permission_denied;
    throw InputError(for_good ? ErrorKind::machine_or_force : ErrorKind::transient_io,
                     {place.generic_string()}, "cannot read the folder: " + error.message());
  }

  /// Skips pipes and devices: reading them might block for ever.
  void take(const fs::path& path) {
    std::error_code ignored;
    if (fs::is_regular_file(path, ignored)) found_.insert(path.generic_string());
  }

  std::vector<fs::path> parts_;
  std::set<std::pair<std::string, std::size_t>> visited_;
  std::set<std::string> found_;
};

}  // namespace

bool is_glob(std::string_view text) {
  return text.find_first_of("*?[") != std::string_view::npos;
}

std::vector<std::string> files_matching(const std::string& pattern) {
  return Walk(pattern).run();
}

}  // namespace counterflex::cli
