#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <set>

#include "counterflex/files/file_writer.hpp"
#include "counterflex/files/files.hpp"
#include "counterflex/files/system.hpp"

namespace counterflex {
namespace {

constexpr std::string_view temporary_ending = ".tmp";

/// Removes the digits at the end; there must be at least one.
std::string_view without_digits(std::string_view text) {
  const std::size_t last = text.find_last_not_of("0123456789");
  return last == std::string_view::npos || last + 1 == text.size() ? "" : text.substr(0, last + 1);
}

/// The place of the temporary file for `path`: beside the target of a link.
std::filesystem::path written_path(const std::string& path) {
  std::error_code error;
  const std::filesystem::path target = std::filesystem::canonical(path, error);
  return error ? std::filesystem::path(path) : target;
}

std::size_t sweep_folder(const std::filesystem::path& folder, const std::set<std::string>& names,
                         bool abandoned_alone) {
  std::error_code ignored;
  std::vector<std::filesystem::path> left;
  for (std::filesystem::directory_iterator entry(folder, ignored), end; entry != end;
       entry.increment(ignored)) {
    const std::string name = entry->path().filename().generic_string();
    if (names.contains(std::string(wanted_name(name))) &&
        entry->symlink_status(ignored).type() == std::filesystem::file_type::regular)
      left.push_back(entry->path());
  }
  std::size_t removed = 0;
  for (const std::filesystem::path& file : left)
    if (abandoned_alone ? system::remove_abandoned(file.generic_string())
                        : std::filesystem::remove(file, ignored))
      ++removed;
  return removed;
}

}  // namespace

std::string temporary_stem(const std::string& name) {
  constexpr std::size_t longest = 220, kept = 150, digits = 16;  // of the 255 bytes of a name
  return name.size() <= longest ? name : name.substr(0, kept) + '~' + sha256(name).substr(0, digits);
}

std::string temporary_name(const std::string& path, long pid, unsigned counter) {
  const std::size_t name = path.size() - std::filesystem::path(path).filename().generic_string().size();
  return fmt::format("{}{}.{}-{}{}", path.substr(0, name), temporary_stem(path.substr(name)), pid, counter,
                     temporary_ending);
}

std::string_view wanted_name(std::string_view name) {
  if (!name.ends_with(temporary_ending)) return {};
  name.remove_suffix(temporary_ending.size());
  name = without_digits(name);
  if (!name.ends_with('-')) return {};
  name = without_digits(name.substr(0, name.size() - 1));
  return name.ends_with('.') ? name.substr(0, name.size() - 1) : "";
}

namespace {

std::size_t sweep(const std::vector<std::string>& paths, bool abandoned_alone) {
  std::map<std::filesystem::path, std::set<std::string>> names;
  for (const std::string& path : paths) {
    const std::filesystem::path file = written_path(path);
    if (!file.filename().empty())
      names[file.has_parent_path() ? file.parent_path() : "."].insert(
          temporary_stem(file.filename().generic_string()));
  }
  std::size_t removed = 0;
  for (const auto& [folder, files] : names) removed += sweep_folder(folder, files, abandoned_alone);
  return removed;
}

}  // namespace

std::size_t sweep_temporaries(const std::vector<std::string>& paths) {
  return sweep(paths, false);
}

std::size_t sweep_abandoned(const std::vector<std::string>& paths) {
  return sweep(paths, true);
}

}  // namespace counterflex
