#pragma once
/// The tools of a machine file.
#include "counterflex/machine/machine.hpp"
#include "toml/source.hpp"

namespace counterflex::toml_file {

/// Reads the tables `[tools.T3]` into `machine`.
void read_tools(const toml::table& document, const Source& source, Machine& machine);

}  // namespace counterflex::toml_file
