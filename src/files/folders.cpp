#include <fmt/format.h>

#include <cerrno>
#include <filesystem>

#include "counterflex/files/files.hpp"
#include "counterflex/files/input_error.hpp"
#include "counterflex/files/system.hpp"
#include "files/descriptor.hpp"

namespace counterflex {
namespace {

[[noreturn]] void fail_at_folder(const std::string& folder, const char* what) {
  throw InputError(kind_of_writing(errno), {folder},
                   fmt::format("cannot {} the folder: {}", what, system::reason_of(errno)));
}

/// Ignores folders that are writable but not readable, and file systems that cannot sync folders. A file
/// system that has become read-only is an error.
bool cannot_be_synced(int error) {
  return error == EACCES || error == EPERM || error == EINVAL || error == ENOTSUP || error == ENOSYS;
}

}  // namespace

std::string folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().generic_string();
  return folder.empty() ? "." : folder;
}

void make_folder(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return;
  const std::string above = folder_of(path);
  if (above != path) make_folder(above);
  if (!system::make_folder(path) && (errno != EEXIST || !std::filesystem::is_directory(path, ignored)))
    fail_at_folder(path, "make");
  sync_folder(above);
}

void sync_folder(const std::string& folder) {
  if (!system::flush_names_to_disk(folder) && !cannot_be_synced(errno)) fail_at_folder(folder, "sync");
}

}  // namespace counterflex
