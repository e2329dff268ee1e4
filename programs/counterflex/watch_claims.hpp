#pragma once
/// Which program of a watched folder each output is of: two that would have one name are not to replace each
/// other's.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "options.hpp"

namespace counterflex::cli {

/// All files that the job writes.
std::vector<std::string> files_of_watch_job(const Options& job);

/// An output that another program of the folder has.
struct TakenOutput {
  std::string path, owner;
};

class OutputClaims {
 public:
  /// From now on the outputs of `job` are its program's, and those that were so before no longer are; unless
  /// one of them, which is returned, is that of another program which is still there: then it has none.
  std::optional<TakenOutput> claim(const Options& job);

 private:
  std::map<std::string, std::string> owners_;  ///< program by output, each by its one name
};

}  // namespace counterflex::cli
