#pragma once
/// What is beside the machine: the fixture of the part, and the temperature.
#include "counterflex/machine/machine.hpp"
#include "toml/source.hpp"

namespace counterflex::toml_file {

/// The table `[fixture]`; `machine` has its work offsets.
void read_fixture(const toml::table& document, const Source& source, Machine& machine);

/// The table `[thermal]`.
void read_thermal(const toml::table& document, const Source& source, Machine& machine);

}  // namespace counterflex::toml_file
