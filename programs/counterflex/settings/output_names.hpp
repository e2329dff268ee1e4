#pragma once
/// Resolves output names that are folders or patterns.
#include <string>
#include <vector>

#include "counterflex/settings/project_file.hpp"
#include "settings/options.hpp"

namespace counterflex::cli {

/// Adds a slash to an output that is an existing folder.
Setting with_folder_marked(Setting output);

/// Throws `InputError` (ErrorKind::usage) for an unknown word in braces; `name` is the name of the option.
void check_pattern(const std::string& name, const std::string& text);

/// Replaces folders and patterns of output, report and plot by the paths for the program of `options`. Adds
/// folders that may have to be created to `Options::folders`. Standard input has no name: patterns of a file
/// or the environment that need one are ignored, those of flags throw `InputError` (ErrorKind::usage).
/// `options` was made from `settings`. Does nothing for `watch`, which resolves names for each program.
void name_outputs(Options& options, const std::vector<Setting>& settings);

/// Adds a remark to `options` if output, report or plot of a file have one name for all programs: each run
/// would replace the files of the previous one.
void remark_on_name(const Setting& setting, Options& options);

/// "part.ngc" gives "part.comp.ngc".
std::string default_output(const std::string& program);

}  // namespace counterflex::cli
