#pragma once
/// What a batch has done, in a file that a later run can trust.
///
/// JSON in lines, so that a person can read it and a program can say where it is wrong:
///
///     {"format":"counterflex-manifest 1","version":"0.1.0","plan":"<SHA-256>","jobs":[
///     {"key":"<SHA-256>","program":"parts/O1001.ngc","output":"corrected/O1001.ngc","exit":0, ...},
///     {"key": ... }
///     ],
///     "sha256":"<SHA-256 of all bytes before this line>"}
///
/// The last line is the proof that nothing is missing and nothing was changed. A job's line holds the members
/// of `JobOutcome` by their names, `inputs` and `outputs` as lists of {"path", "sha256"}, null where there is
/// no number. Paths and diagnostics are bytes, JSON is UTF-8: a byte that is none is written as % and two
/// hexadecimal digits, % as %25.
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/batch/job_outcome.hpp"

namespace counterflex {

struct Manifest {
  std::string version;           ///< of the program that did the jobs
  std::string plan;              ///< SHA-256 of the list of jobs and the shard: what the jobs are a part of
  std::vector<JobOutcome> jobs;  ///< those that have ended, in the order of the batch; no two write one file
  bool operator==(const Manifest&) const = default;
};

std::string to_text(const Manifest& manifest);

/// Takes only what `to_text` writes, byte for byte. Throws `InputError` (Exit::machine_or_force) with the
/// place in `file` where `text` was cut off or changed, is of another format, or names a file that two jobs
/// write; it says how to go on.
Manifest read_manifest(std::string_view text, const std::string& file);

/// Hashes of files, each read once, however many jobs share it.
class FileHashes {
 public:
  /// None where `path` is no regular file or cannot be read.
  const std::optional<std::string>& of(const std::string& path);

 private:
  std::map<std::string, std::optional<std::string>> known_;
};

/// Whether a job need not be done again: it was `done` with the same `key`, and each of its inputs and
/// outputs, of which there is at least one, is on the disk as it was recorded. Does not throw.
bool is_proven(const JobOutcome& recorded, const std::string& key, FileHashes& on_disk);

}  // namespace counterflex
