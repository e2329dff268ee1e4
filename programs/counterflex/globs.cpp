#include "globs.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <filesystem>
#include <set>

namespace counterflex::cli {
namespace {

namespace fs = std::filesystem;

/// Goes through the folders that the parts of a pattern match, one part a level.
class Walk {
 public:
  explicit Walk(const fs::path& pattern) : parts_(pattern.begin(), pattern.end()) {}

  std::vector<std::string> run() {
    go({}, 0);
    return {found_.begin(), found_.end()};
  }

 private:
  void go(const fs::path& at, std::size_t part) {
    if (part == parts_.size()) return take(at);
    const std::string& name = parts_[part].native();
    if (!is_glob(name)) return go(at / parts_[part], part + 1);
    if (name == "**") go(at, part + 1);
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(at.empty() ? "." : at, ignored)) {
      const std::string entry_name = entry.path().filename().native();
      if (::fnmatch(name == "**" ? "*" : name.c_str(), entry_name.c_str(), FNM_PERIOD) != 0) continue;
      if (name != "**")
        go(at / entry_name, part + 1);
      else if (entry.is_directory(ignored) && !entry.is_symlink(ignored))
        go(at / entry_name, part);
    }
  }

  void take(const fs::path& path) {
    std::error_code ignored;
    if (fs::exists(path, ignored) && !fs::is_directory(path, ignored)) found_.insert(path.native());
  }

  std::vector<fs::path> parts_;
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
