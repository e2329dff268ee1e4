#pragma once
/// What a batch has done, in a file that a later run can trust.
///
/// JSON in lines, so that a person can read it and a program can report where it is wrong:
///
///     {"format":"counterflex-manifest 1","version":"0.1.0","plan":"<SHA-256>","jobs":[
///     {"key":"<SHA-256>","program":"parts/O1001.ngc","output":"corrected/O1001.ngc","exit":0, ...},
///     {"key": ... }
///     ],
///     "sha256":"<SHA-256 of all bytes before this line>"}
///
/// The last line is the proof that nothing is missing and nothing was changed. A job's line holds the members
/// of `JobOutcome` by their names, `inputs` and `outputs` as lists of {"path", "sha256"}, null where there is
/// no number. Paths and diagnostics are bytes, JSON is UTF-8: a byte that is not part of a UTF-8 character is
/// written as % and two hexadecimal digits, % as %25.
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/files/input_error.hpp"

namespace counterflex {

// The result of one job of a batch: the manifest keeps it, and the summary shows it.

/// A file and the SHA-256 of its bytes (64 lower-case hexadecimal digits).
struct FileHash {
  std::string path;
  std::string sha256;
  bool operator==(const FileHash&) const = default;
};

/// The exit status of a job's process for a kind of error: not 0, and another one for each kind. The program
/// that runs the jobs defines it; manifests and summaries hold its numbers, and 0 for a job that is done.
using ExitStatusOf = int (*)(ErrorKind);

struct JobOutcome {
  /// SHA-256 of what decides the outputs besides the bytes of the inputs: version and options.
  std::string key;
  std::string program;  ///< path of the original
  std::string output;   ///< path of the corrected program, which no other job of the batch has
  std::optional<ErrorKind> error_kind;  ///< none: done
  std::string verdict = "FAILED";       ///< of the run's report; FAILED where it came to none
  std::string verdict_reason;           ///< as in the report
  std::string error;                    ///< the first diagnostic of a job that failed
  std::vector<FileHash> inputs;         ///< as they were read; if it failed, all as they were before it ran
  std::vector<FileHash> outputs;  ///< as they were written, the corrected program first where there is one
  std::optional<double> before_mm,
      after_mm;  ///< largest deviation of feed moves; none where nothing was solved
  std::optional<double> corrected_percent;     ///< of the cutting length
  std::optional<std::size_t> warnings, moves;  ///< none if an input was refused before they were counted
  bool operator==(const JobOutcome&) const = default;
};

/// A JSON object on one line, without its end; numbers are read back as they were.
std::string to_json_line(const JobOutcome& outcome, ExitStatusOf exit_status);

/// Throws `InputError` (ErrorKind::internal), without a place, where `line` is not what `to_json_line`
/// writes.
JobOutcome outcome_of(std::string_view line, ExitStatusOf exit_status);

struct Manifest {
  std::string version;           ///< of the program that did the jobs
  std::string plan;              ///< SHA-256 of the list of jobs and the shard: what the jobs are a part of
  std::vector<JobOutcome> jobs;  ///< those that have ended, in the order of the batch; no two write one file
  bool operator==(const Manifest&) const = default;
};

std::string to_text(const Manifest& manifest, ExitStatusOf exit_status);

/// Takes only what `to_text` writes, byte for byte. Throws `InputError` (ErrorKind::machine_or_force) with
/// the place in `file` where `text` was cut off or changed, is of another format, or names a file that two
/// jobs write. The message states how to continue.
Manifest read_manifest(std::string_view text, const std::string& file, ExitStatusOf exit_status);

/// Hashes of files, each read once, however many jobs share it.
class FileHashes {
 public:
  /// None where `path` is not a regular file or cannot be read.
  const std::optional<std::string>& of(const std::string& path);

 private:
  std::map<std::string, std::optional<std::string>> known_;
};

/// Whether a job need not be done again: it was `done` with the same `key`, and each of its inputs and
/// outputs, of which there is at least one, is on the disk as it was recorded. Does not throw.
bool is_proven(const JobOutcome& recorded, const std::string& key, FileHashes& on_disk);

// Which jobs of a batch each of several machines does.

/// "I/N": shard I of N, from 1.
struct Shard {
  int index = 1;
  int count = 1;
};

inline constexpr int most_shards = 100000;

/// Throws `InputError` (ErrorKind::usage) for anything but two whole numbers of which the first is not
/// larger.
Shard read_shard(std::string_view text);

/// The jobs of each of `shards` shards, by `work` of the jobs (any unit, positive): the largest first, each
/// job goes to the shard that has least to do. The result depends on the arguments only. Jobs of a shard are
/// in ascending order.
std::vector<std::vector<std::size_t>> plan_shards(const std::vector<double>& work, int shards);

// What a batch has come to: for people, and for programs.

/// Whether a job that failed so would fail again with the same inputs: it was understood and refused.
bool fails_again(ErrorKind error);

/// The outcomes, worst first: those that failed, those whose verdict PARTLY was accepted, then by the
/// deviation that is left, then by the one before, the largest first; equal ones by the path of the program.
std::vector<JobOutcome> worst_first(std::vector<JobOutcome> outcomes);

/// "done", or what failed, in a few words: "not within tolerance".
std::string_view status_text(const std::optional<ErrorKind>& error);

/// The same; of a job whose verdict is PARTLY or NOTHING CORRECTED, that.
std::string_view status_text(const JobOutcome& outcome);

/// The error of a batch: none where all are done; `transient_io` where one may succeed if it is tried again;
/// else the first kind, in the order of `ErrorKind`, of those that failed.
std::optional<ErrorKind> error_of(const std::vector<JobOutcome>& outcomes);

/// One table of at most `most_rows` jobs, worst first, with what is to be known of the others, and the
/// diagnostics of these that failed. Lengths in mm.
std::string summary_table(const std::vector<JobOutcome>& outcomes, std::size_t most_rows);

/// {"schema": "counterflex-batch 1", "tool", "counts": {"jobs", "done", "partly", "failed"},
/// "exit_status", "jobs": [{"program", "output", "verdict", "verdict_reason", "status", "exit_status",
/// "error", "before_mm", "after_mm", "corrected_percent", "warnings", "moves", "inputs": [{"path",
/// "sha256"}], "outputs": [...]}]}, worst first. `version` is the tool's.
std::string summary_json(const std::vector<JobOutcome>& outcomes, std::string_view version,
                         ExitStatusOf exit_status);

/// The first row of the table of jobs.
inline constexpr std::string_view summary_columns =
    "program,output,status,exit_status,before_mm,after_mm,corrected_percent,warnings,moves,error,verdict,"
    "verdict_reason";

/// The same jobs as rows of `summary_columns`; fields quoted as RFC 4180 has it.
std::string summary_csv(const std::vector<JobOutcome>& outcomes, ExitStatusOf exit_status);

}  // namespace counterflex
