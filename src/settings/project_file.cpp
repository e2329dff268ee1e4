#include "counterflex/settings/project_file.hpp"

#include <filesystem>

#include "counterflex/files/system.hpp"
#include "settings/read_settings.hpp"

namespace counterflex {
namespace {

namespace fs = std::filesystem;

/// The shorter of the two names of `path`.
std::string short_name(const fs::path& path, const fs::path& from) {
  const std::string relative = path.lexically_relative(from).generic_string();
  return relative.empty() || relative.size() > path.generic_string().size() ? path.generic_string()
                                                                            : relative;
}

bool is_project_file(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(path, ignored)) && !fs::is_directory(path, ignored) &&
         !system::is_standard_output(path.generic_string());
}

}  // namespace

std::vector<Setting> read_project(std::string_view text, const std::string& file) {
  const toml_file::Source source(text, file);
  const toml::table document = source.parse();
  setting_file::check_format_of(document, "counterflex-project 1", "a project file", source);
  return setting_file::read_settings(document, "a project file", setting_file::folder_of(file), {"format"},
                                     source);
}

void refuse_special_file(const std::string& file) {
  std::error_code ignored;
  const fs::file_status status = fs::status(file, ignored);
  if (!fs::exists(status) || fs::is_regular_file(status) || fs::is_directory(status)) return;
  throw InputError(ErrorKind::machine_or_force, {file},
                   "cannot read the file: it is a pipe or a device, and must be a regular file");
}

std::optional<std::string> find_project_file(const std::string& program) {
  std::error_code nowhere;
  const fs::path here = fs::current_path(nowhere);
  fs::path folder = here;
  if (!program.empty() && program != "-") folder = (here / program).lexically_normal().parent_path();
  if (!folder.is_absolute()) return std::nullopt;  // the working directory has been removed
  for (;; folder = folder.parent_path()) {
    const fs::path file = folder / "counterflex.toml";
    if (is_project_file(file)) {
      const std::string name = short_name(file, here);
      refuse_special_file(name);
      return name;
    }
    if (folder == folder.parent_path()) return std::nullopt;
  }
}

}  // namespace counterflex
