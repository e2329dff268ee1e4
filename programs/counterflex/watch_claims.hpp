#pragma once
/// Which program of a watched folder each output is of: two that would have one name are not to replace each
/// other's.
#include <map>
#include <string>
#include <vector>

#include "options.hpp"

namespace counterflex::cli {

/// All files that the job writes.
std::vector<std::string> files_of_watch_job(const Options& job);

class OutputClaims {
 public:
  /// From now on the outputs of `job` are its program's, and those that were so before no longer are. Throws
  /// `InputError` (Exit::usage) at the program where one of them is that of another program which is still
  /// there; then it has none.
  void claim(const Options& job);

 private:
  std::map<std::string, std::string> owners_;  ///< program by output, each by its one name
};

}  // namespace counterflex::cli
