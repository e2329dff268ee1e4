#include <unistd.h>

#include "counterflex/files/system.hpp"

namespace counterflex::system {

bool is_standard_output(const std::string& path) {
  const auto output = facts_of(STDOUT_FILENO);
  if (!output || output->kind != FileKind::file) return false;
  const auto file = facts_of(path);
  return file && file->device == output->device && file->inode == output->inode;
}

}  // namespace counterflex::system
