#pragma once
/// Lists of jobs: the files of `counterflex batch`.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/settings/project_file.hpp"

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
/// Throws `InputError` (ErrorKind::machine_or_force) with line and column.
JobsFile read_jobs(std::string_view text, const std::string& file);

// Names of outputs that are made of the name of the program: `{name}_CF{ext}`.

/// The texts that replace the words in braces, as far as they are known.
struct NameParts {
  std::optional<std::string> name;    ///< {name}: the program's file name without its extension
  std::optional<std::string> ext;     ///< {ext}: the extension with its dot, empty without one
  std::optional<std::string> output;  ///< {output}: the path of the output without its extension
};

/// Whether `text` holds a word of letters in braces, known or not; other braces are parts of names.
bool is_pattern(std::string_view text);

/// The text that `fill` makes `path` of: "{{}" is a brace that begins a word.
std::string as_pattern(std::string_view path);

/// The first word in braces that `allowed` does not have; empty: none.
std::string unknown_placeholder(std::string_view pattern, const NameParts& allowed);

/// The word that an unknown one was probably meant to be; empty: none.
std::string nearest_placeholder(std::string_view word);

/// `pattern` with the parts in their places; unknown words stay as they are.
std::string fill(std::string_view pattern, const NameParts& parts);

}  // namespace counterflex
