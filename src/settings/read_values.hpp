#pragma once
/// Values of settings out of TOML nodes, as texts of the command line.
#include <string>

#include "counterflex/settings/project_file.hpp"
#include "settings/keys.hpp"
#include "toml/fields.hpp"

namespace counterflex::setting_file {

/// What a value is read with.
struct ValueContext {
  const std::string& name;    ///< what messages call the value
  const std::string& folder;  ///< of relative paths
  const toml_file::Source& source;
};

/// Adds what `node` says to the values of `setting`. Throws `InputError` at the place of what is of another
/// type.
void read_value(const toml::node& node, Kind kind, const ValueContext& context, Setting& setting);

}  // namespace counterflex::setting_file
