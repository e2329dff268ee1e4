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

bool is_same_file(const std::string& a, const std::string& b) {
  if (a == "-" || b == "-") return false;
  std::error_code error;
  if (std::filesystem::equivalent(a, b, error)) return true;
  return std::filesystem::weakly_canonical(a, error) == std::filesystem::weakly_canonical(b, error);
}

}  // namespace counterflex::cli
