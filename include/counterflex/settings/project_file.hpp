#pragma once
/// Project files, `counterflex.toml`: what all programs of a folder, and of those below it, have in common.
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/files/input_error.hpp"

namespace counterflex {

// The value that a file, the environment or a flag gives to one option of the command line.

enum class Origin { flag, environment, file, builtin };

/// Values as the command line takes them, so that one piece of code judges them all. A switch has "true" or
/// "false". Without values the option is as if it had never been given: `report = false` hides what the
/// project file sets for reports.
struct Setting {
  std::string option;               ///< its long name without dashes: "tolerance-mm"
  std::vector<std::string> values;  ///< paths of files are joined with the folder of the file that gives them
  Location where;  ///< in a file: of the value; of the environment: the variable as a file without lines
  Origin origin = Origin::file;
  std::vector<Location> places{};  ///< in a file: of each value
};

/// The place of value `i`.
const Location& place_of(const Setting& setting, std::size_t i);

/// What a person who wrote the setting calls it: "--tolerance-mm", "COUNTERFLEX_TOLERANCE_MM",
/// "tolerance_mm".
std::string shown_option(std::string_view option, Origin origin);

/// Reads a project file; `file` is its path, with which messages begin and which its paths are relative to.
///
///     format = "counterflex-project 1"
///     machine = "machine.toml"
///     forces = ["forces.csv"]         # or one path; a constant force: force = [215, -10, -25]
///     tolerance_mm = 0.005
///     output = "corrected/{name}_CF{ext}"
///     report = true                   # beside the output; a pattern of names; false: none
///
///     [work.G54]
///     xyz_mm = [120, 80, 35]
///     datum = { touched_at_mm = [0, 0, 0] }   # or "machine"
///
///     [tools.T1]
///     length_mm = 50
///
/// Settings come in the order of the keys' list, not of the file. Throws `InputError`
/// (ErrorKind::machine_or_force) with line and column.
std::vector<Setting> read_project(std::string_view text, const std::string& file);

/// A project file that gives `settings`, each with its origin as a comment. A file of this text in the
/// working directory gives the same values, numbers in their shortest form. Throws `InputError` for a value
/// that is not UTF-8: ErrorKind::machine_or_force at the place of a file's, else ErrorKind::usage.
std::string to_project_text(const std::vector<Setting>& settings);

/// A key of TOML: in quotation marks where it needs them.
std::string toml_key(const std::string& name);

/// The nearest `counterflex.toml` in the folder of `program` or above it; of the working directory where
/// `program` is empty or "-". The path is relative to the working directory unless that is longer. Folders of
/// that name are ignored, and so is the file that standard output is written to: the shell has emptied
/// it. Throws as `refuse_special_file` does; a link to nothing is found, to be missed by who reads it.
std::optional<std::string> find_project_file(const std::string& program);

/// Throws `InputError` (ErrorKind::machine_or_force) for a pipe or a device, whose reader could wait for
/// ever.
void refuse_special_file(const std::string& file);

}  // namespace counterflex
