#pragma once
/// The files of the jobs of a batch or a watch: no job may replace a file of another one.
#include <map>
#include <set>
#include <string>

namespace counterflex::cli {

/// One name for all paths of a file, which may not exist.
std::string canonical_name(const std::string& path);

/// Who writes a file: the corrected program, which no other job has, and its original.
struct OutputOwner {
  std::string output, program;
};

class JobFiles {
 public:
  void add_input(const std::string& path) { inputs_.insert(canonical_name(path)); }
  bool is_input(const std::string& path) const { return inputs_.contains(canonical_name(path)); }

  /// Adds a file that a job writes. Returns another job that has it already, and then changes nothing.
  /// Otherwise returns nullptr.
  const OutputOwner* add_output(const std::string& path, const OutputOwner& owner);

  /// For a file whose name the job of the corrected program `output` has found only now. Throws `InputError`
  /// (ErrorKind::usage) if it is an input of a job, or an output of another one.
  void refuse_others(const std::string& path, const std::string& output) const;

 private:
  const OutputOwner* other_owner(const std::string& name, const std::string& output) const;

  std::set<std::string> inputs_;                ///< canonical names
  std::map<std::string, OutputOwner> outputs_;  ///< by canonical name
};

}  // namespace counterflex::cli
