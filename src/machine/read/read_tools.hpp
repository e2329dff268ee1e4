#pragma once
/// The tools of a machine file.
#include "counterflex/machine/machine.hpp"
#include "toml/source.hpp"

namespace counterflex::toml_file {

/// Reads the tables `[tools.T3]` into `machine`.
void read_tools(const toml::table& document, const Source& source, Machine& machine);

/// The `mass` of a tool: its place from the tip in the tip's axes, z to the spindle.
PointMass read_tool_mass(const toml::node& node, const Source& source);

}  // namespace counterflex::toml_file
