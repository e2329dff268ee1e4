#pragma once
/// What became of one job of a batch: what the manifest keeps, and the summary shows.
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/files/input_error.hpp"

namespace counterflex {

/// A file and the SHA-256 of its bytes (64 lower-case hexadecimal digits).
struct FileHash {
  std::string path;
  std::string sha256;
  bool operator==(const FileHash&) const = default;
};

struct JobOutcome {
  std::string
      key;  ///< SHA-256 of what decides the outputs besides the bytes of the inputs: version and options
  std::string program;  ///< path of the original
  std::string output;   ///< path of the corrected program, which no other job of the batch has
  Exit exit = Exit::done;
  std::string verdict = "FAILED";  ///< of the run's report; FAILED where it came to none
  std::string verdict_reason;      ///< as in the report
  std::string error;               ///< the first diagnostic of a job that failed
  std::vector<FileHash> inputs;    ///< as they were read
  std::vector<FileHash> outputs;   ///< as they were written, the corrected program first where there is one
  std::optional<double> before_mm,
      after_mm;  ///< largest deviation of feed moves; none where nothing was solved
  std::optional<double> corrected_percent;  ///< of the cutting length
  std::size_t warnings = 0;
  std::size_t moves = 0;  ///< of the program
  bool operator==(const JobOutcome&) const = default;
};

/// A JSON object on one line, without its end; numbers are read back as they were.
std::string to_json_line(const JobOutcome& outcome);

/// Throws `InputError` (Exit::internal), without a place, where `line` is not what `to_json_line` writes.
JobOutcome outcome_of(std::string_view line);

}  // namespace counterflex
