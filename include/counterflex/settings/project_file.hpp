#pragma once
/// Project files, `counterflex.toml`: what all programs of a folder, and of those below it, have in common.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/settings/setting.hpp"

namespace counterflex {

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
/// (Exit::machine_or_force) with line and column.
std::vector<Setting> read_project(std::string_view text, const std::string& file);

/// A project file that says `settings`, each with its origin as a comment. A file of this text in the working
/// directory gives the same values, numbers in their shortest form. Throws `InputError` for a value that is
/// not UTF-8: Exit::machine_or_force at the place of a file's, else Exit::usage.
std::string to_project_text(const std::vector<Setting>& settings);

/// The nearest `counterflex.toml` in the folder of `program` or above it; of the working directory where
/// `program` is empty or "-". The path is relative to the working directory unless that is longer. Folders of
/// that name are passed over, and so is the file that standard output is written to: the shell has emptied
/// it. Throws as `refuse_special_file` does; a link to nothing is found, to be missed by who reads it.
std::optional<std::string> find_project_file(const std::string& program);

/// Throws `InputError` (Exit::machine_or_force) for a pipe or a device, whose reader could wait for ever.
void refuse_special_file(const std::string& file);

}  // namespace counterflex
