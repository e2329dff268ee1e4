#pragma once
/// Reads settings from TOML.
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/settings/project_file.hpp"
#include "toml/fields.hpp"

namespace counterflex::setting_file {

/// Reads all settings of `table`, which messages call `owner`. Relative paths are relative to `folder`. Keys
/// that are neither settings nor in `other_keys` are errors.
std::vector<Setting> read_settings(const toml::table& table, std::string_view owner,
                                   const std::string& folder, const std::vector<std::string_view>& other_keys,
                                   const toml_file::Source& source);

/// Throws unless `document` has this `format`; `what` is the name of the kind of file.
void check_format_of(const toml::table& document, std::string_view format, std::string_view what,
                     const toml_file::Source& source);

/// The folder of `file`; empty: the working directory.
std::string folder_of(const std::string& file);

/// `path` relative to the working directory; "-" and absolute paths are not changed.
std::string joined_path(const std::string& folder, const std::string& path);

/// The same for the name of an output, which may be a pattern. A pattern without a folder is beside the
/// program. Only `name` is a pattern: braces in `folder` are literal.
std::string joined_output(const std::string& folder, const std::string& name);

}  // namespace counterflex::setting_file
