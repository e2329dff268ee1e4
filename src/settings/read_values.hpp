#pragma once
/// Reads values of settings from TOML nodes as texts of the command line.
#include <string>

#include "counterflex/settings/project_file.hpp"
#include "settings/keys.hpp"
#include "toml/fields.hpp"

namespace counterflex::setting_file {

/// Context of a value.
struct ValueContext {
  const std::string& name;    ///< name of the value in messages
  const std::string& folder;  ///< base of relative paths
  const toml_file::Source& source;
};

/// Adds the values of `node` to `setting`. Throws `InputError` at a value of another type.
void read_value(const toml::node& node, Kind kind, const ValueContext& context, Setting& setting);

}  // namespace counterflex::setting_file
