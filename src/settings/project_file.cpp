#include "counterflex/settings/project_file.hpp"

#include <filesystem>

#include "settings/read_settings.hpp"

namespace counterflex {
namespace {

namespace fs = std::filesystem;

/// The shorter of the two names of `path`.
std::string short_name(const fs::path& path, const fs::path& from) {
  const std::string relative = path.lexically_relative(from).string();
  return relative.empty() || relative.size() > path.string().size() ? path.string() : relative;
}

}  // namespace

std::vector<Setting> read_project(std::string_view text, const std::string& file) {
  const toml_file::Source source(text, file);
  const toml::table document = source.parse();
  setting_file::check_format_of(document, "counterflex-project 1", "a project file", source);
  return setting_file::read_settings(document, "a project file", setting_file::folder_of(file), {"format"},
                                     source);
}

std::optional<std::string> find_project_file(const std::string& program) {
  std::error_code nowhere;
  const fs::path here = fs::current_path(nowhere);
  fs::path folder = here;
  if (!program.empty() && program != "-") folder = (here / program).lexically_normal().parent_path();
  if (!folder.is_absolute()) return std::nullopt;  // the working directory has been removed
  for (;; folder = folder.parent_path()) {
    std::error_code ignored;
    const fs::path file = folder / "counterflex.toml";
    if (fs::exists(file, ignored) && !fs::is_directory(file, ignored)) return short_name(file, here);
    if (folder == folder.parent_path()) return std::nullopt;
  }
}

}  // namespace counterflex
