#pragma once
/// Lists of jobs: the files of `counterflex batch`.
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/settings/setting.hpp"

namespace counterflex {

/// One `[[job]]`: programs that are treated alike.
struct JobEntry {
  std::vector<std::string> programs;  ///< paths and globs, joined with the folder of the jobs file; not empty
  Location where;                     ///< of the [[job]]
  std::vector<Setting> settings;
};

struct JobsFile {
  std::string output;  ///< folder of the batch, joined with that of the jobs file; no slash at its end
  std::vector<Setting> defaults;  ///< for all jobs; `output` is among them
  std::vector<JobEntry> jobs;     ///< at least one
};

/// Reads a list of jobs; `file` is its path, with which messages begin and which its paths are relative to.
///
///     format = "counterflex-jobs 1"
///     output = "corrected"            # required: a folder, or FOLDER/PATTERN
///     machine = "machine.toml"        # any setting of a project file: the defaults of all jobs
///
///     [[job]]
///     program = "parts/*.ngc"         # required: a path, a glob, or an array of these
///     output = "left"                 # a folder, or a pattern of names
///
/// In an `output` of a jobs file a text without a pattern is a folder: the setting's value ends in a slash.
/// Throws `InputError` (Exit::machine_or_force) with line and column.
JobsFile read_jobs(std::string_view text, const std::string& file);

}  // namespace counterflex
