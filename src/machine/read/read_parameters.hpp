#pragma once
/// Values, sources and standard deviations of a machine's parameters.
#include "counterflex/machine/machine.hpp"
#include "toml/source.hpp"

namespace counterflex::toml_file {

/// Reads the optional table `parameters`. A `value` replaces that of the machine's elements; `machine` has
/// its chains.
void read_parameters(const toml::table& document, const Source& source, Machine& machine);

}  // namespace counterflex::toml_file
