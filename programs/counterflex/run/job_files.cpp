#include "run/job_files.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "counterflex/files/input_error.hpp"
#include "counterflex/files/text.hpp"

namespace counterflex::cli {

std::string canonical_name(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path canonical = fs::weakly_canonical(fs::absolute(path, ignored), ignored);
  return canonical.empty() ? path : canonical.generic_string();
}

const OutputOwner* JobFiles::other_owner(const std::string& name, const std::string& output) const {
  const auto found = outputs_.find(name);
  return found == outputs_.end() || found->second.output == output ? nullptr : &found->second;
}

const OutputOwner* JobFiles::add_output(const std::string& path, const OutputOwner& owner) {
  const std::string name = canonical_name(path);
  outputs_.emplace(name, owner);
  return other_owner(name, owner.output);
}

void JobFiles::refuse_others(const std::string& path, const std::string& output) const {
  const std::string name = canonical_name(path);
  if (inputs_.contains(name))
    throw InputError(ErrorKind::usage, {path},
                     "the file is an input of these jobs, and inputs are never overwritten; give outputs "
                     "another folder");
  if (const OutputOwner* other = other_owner(name, output))
    throw InputError(ErrorKind::usage, {path},
                     fmt::format("the file is also an output of the job of {}; give one of the jobs another "
                                 "folder",
                                 without_controls(other->program)));
}

}  // namespace counterflex::cli
