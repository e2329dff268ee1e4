#pragma once
/// Settings that the environment gives: COUNTERFLEX_MACHINE, COUNTERFLEX_TOLERANCE_MM ...
#include <string>
#include <utility>
#include <vector>

#include "counterflex/settings/project_file.hpp"

namespace counterflex {

/// The settings among `variables`, "NAME=VALUE" each as `environ` has them, whose end is nullptr. Several
/// values of one option have ':' between them, as in PATH; a report or plot may be "true" or "false",
/// as in a project file; an empty value counts as not set. Other variables are ignored. Values are not
/// judged. Paths and names of outputs are those of files in `folder`, as in a project file there; empty: the
/// working directory.
std::vector<Setting> read_environment(const char* const* variables, const std::string& folder = {});

/// Variables whose names are nearly those of settings, each with what was probably meant:
/// COUNTERFLEX_TOLERANCE.
std::vector<std::pair<std::string, std::string>> misspelt_variables(const char* const* variables);

}  // namespace counterflex
