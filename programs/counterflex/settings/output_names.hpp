#pragma once
/// Names of outputs that are said by a folder or a pattern.
#include <string>
#include <vector>

#include "counterflex/settings/project_file.hpp"
#include "settings/options.hpp"

namespace counterflex::cli {

/// An output that is a folder which exists, with the slash of a folder.
Setting with_folder_marked(Setting output);

/// Throws `InputError` (Exit::usage) for a word in braces that nothing stands for; `name` is the option's.
void check_pattern(const std::string& name, const std::string& text);

/// Turns folders and patterns of output, report and plot into the paths for the program of `options`, and
/// notes in `Options::folders` those folders that may have to be made. Standard input has no name: what a
/// file or the environment says that needs one is then left out, and a flag throws `InputError`
/// (Exit::usage). `settings` are those that `options` was made of. Nothing for `watch`, whose programs
/// are named one by one.
void name_outputs(Options& options, const std::vector<Setting>& settings);

/// Notes in `options` an output, report or plot of a file that has one name for all programs: each run takes
/// the place of the one before.
void remark_on_name(const Setting& setting, Options& options);

/// "part.ngc" gives "part.comp.ngc".
std::string default_output(const std::string& program);

}  // namespace counterflex::cli
