#pragma once
/// The jobs of a batch, ready to be done.
#include <string>
#include <vector>

#include "settings/options.hpp"

namespace counterflex::cli {

struct BatchJob {
  std::string program, output;  ///< paths
  Options options;              ///< of `compensate`
  std::string key;              ///< of the outcome: SHA-256 of version, options and paths
  double work = 0;              ///< of any unit: bytes of the program, weighed by what is done with them
};

/// All files that a job writes.
std::vector<std::string> files_written(const BatchJob& job);

/// What a jobs file asks for.
struct Batch {
  std::string folder;          ///< where summary and state are kept
  std::vector<BatchJob> jobs;  ///< in the order of the file, those of a glob by name; no two have one output
  int threads = 1;             ///< for all of them together
  bool force_overwrite = false;  ///< of the summary, too
};

/// Reads `file`, finds the programs, and settles the options of each, in which jobs go before defaults, these
/// before the environment, and this before the project file of the program. Relative paths of the environment
/// are those of `from`. A program that is not there is a job, which will fail; a glob without one is an
/// error, and programs that are corrected already are left out of it. Throws `InputError`:
/// Exit::machine_or_force, with the place, for what is wrong with the file, and where a job would write a
/// file that another one reads or writes; as `files_matching`. `flags` go before what environment and file
/// say of the batch as a whole.
Batch read_batch(const std::string& file, const std::string& from, const std::vector<Setting>& flags);

}  // namespace counterflex::cli
