#pragma once
/// The jobs of a batch, ready to run.
#include <string>
#include <vector>

#include "run/job_files.hpp"
#include "settings/layers.hpp"
#include "settings/options.hpp"

namespace counterflex::cli {

struct BatchJob {
  std::string program, output;  ///< paths
  Options options;              ///< of `compensate`
  std::string key;              ///< of the outcome: SHA-256 of version, options and paths
  double work = 0;              ///< relative cost: bytes of the program, weighted by method and causes
  /// Canonical names of the data lists that the job writes if it changes them. Jobs that have one of them in
  /// common run one after the other, in the order of the batch: the first that changes it writes it.
  std::vector<std::string> shared_lists{};
};

/// `BatchJob::key` of a job with these settings: everything besides the inputs that affects the bytes of the
/// outputs: all options, and all paths (reports contain them), with those of the data lists that the program
/// has now.
std::string key_of(const Layers& layers, const BatchJob& job);

/// All files that a job writes, without data lists that are written only if they change.
std::vector<std::string> outputs_of(const BatchJob& job);

/// The same with these lists. Parts of a divided program are known only when it has been corrected.
std::vector<std::string> files_written(const BatchJob& job);

/// A jobs file, with all its programs found.
struct Batch {
  std::string folder;          ///< where summary and state are kept
  std::vector<BatchJob> jobs;  ///< in the order of the file, those of a glob by name; no two have one output
  JobFiles files;              ///< inputs and outputs of all jobs
  int threads = 1;             ///< for all of them together
  bool force_overwrite = false;          ///< also replaces a foreign summary
  std::vector<SettingRemark> remarks{};  ///< each once, as `remarks_on_replaced`
};

/// Reads `file`, finds the programs, and resolves the options of each. Priority: job, defaults of the file,
/// environment, project file of the program. Relative paths of the environment are relative to `from`. A
/// missing program is a job that fails. A glob without a match is an error; globs skip corrected programs.
/// `flags` override environment and file for settings of the whole batch. Throws `InputError`:
/// ErrorKind::machine_or_force, with the place, for errors of the file and for jobs that would write an input
/// or output of another job; also as `files_matching`.
Batch read_batch(const std::string& file, const std::string& from, const std::vector<Setting>& flags);

}  // namespace counterflex::cli
