#include "process/read_input.hpp"

#include <filesystem>

#include "counterflex/files/files.hpp"
#include "process/console.hpp"

namespace counterflex::cli {

void refuse_folder(const std::string& path, ErrorKind unreadable) {
  std::error_code ignored;
  if (path != "-" && std::filesystem::is_directory(path, ignored))
    throw InputError(unreadable, {path}, "cannot read the file: it is a folder");
}

std::string read_input(const std::string& path, ErrorKind unreadable) {
  refuse_folder(path, unreadable);
  return or_unreadable(unreadable, [&] { return read_file(path); });
}

}  // namespace counterflex::cli
