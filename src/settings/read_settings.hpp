#pragma once
/// Settings out of TOML.
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/settings/project_file.hpp"
#include "toml/fields.hpp"

namespace counterflex::setting_file {

/// Reads every setting of `table`, which is called `owner`; relative paths are of `folder`. Keys that are
/// neither settings nor among `other_keys` are errors.
std::vector<Setting> read_settings(const toml::table& table, std::string_view owner,
                                   const std::string& folder, const std::vector<std::string_view>& other_keys,
                                   const toml_file::Source& source);

/// Throws unless `document` begins with `format`; `what` says what such a file is.
void check_format_of(const toml::table& document, std::string_view format, std::string_view what,
                     const toml_file::Source& source);

/// The folder of `file`; empty: the working directory.
std::string folder_of(const std::string& file);

/// `path` as it is reached from the working directory; "-" and absolute paths stay as they are.
std::string joined_path(const std::string& folder, const std::string& path);

}  // namespace counterflex::setting_file
