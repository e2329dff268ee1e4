#pragma once
/// Programs of a watched folder that have failed, and what may let them succeed another time.
#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "options.hpp"

namespace counterflex::cli {

/// What tells one state of a file from another.
struct FileStamp {
  std::uint64_t device = 0, inode = 0, size = 0;
  std::int64_t written_ns = 0, changed_ns = 0;  ///< bytes; these, owner and mode
  bool operator==(const FileStamp&) const = default;
};

/// By path; nothing of a file that is not there.
using FileStamps = std::map<std::string, std::optional<FileStamp>>;
FileStamps stamps_of(const std::vector<std::string>& paths);

/// Files where settings of `program` are said, or would be if they were there.
std::vector<std::string> files_with_settings(const Options& watch, const std::string& program);

/// Files besides the program that `job` reads.
std::vector<std::string> files_beside_program(const Options& job);

class WatchFailures {
 public:
  using Clock = std::chrono::steady_clock;

  /// `seen`: the files that may be to blame, as they were. After `pause`, where there is one, another try may
  /// help though none of them has changed.
  void add(const std::string& program, FileStamps seen, std::optional<Clock::duration> pause);

  void erase(const std::string& program) { failures_.erase(program); }
  bool empty() const { return failures_.empty(); }

  /// The programs to try again now; they are failures no more, and neither are those that have gone.
  std::vector<std::string> take_due();

 private:
  struct Failure {
    FileStamps seen;
    std::optional<Clock::time_point> again;
  };

  std::map<std::string, Failure> failures_;
};

}  // namespace counterflex::cli
