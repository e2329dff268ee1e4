#pragma once
/// What loads the machine and its chains may bear.
#include "counterflex/machine/machine.hpp"
#include "toml/source.hpp"

namespace counterflex::toml_file {

/// Reads the kinds of load in [limits], which hold for every chain, and those in the `limits` of a chain,
/// which go before them, into `machine`, whose chains have been read. A file without any leaves `load_limits`
/// empty.
void read_load_limits(const toml::table& document, const Source& source, Machine& machine);

/// The keys of kinds of load, behind `others`.
std::vector<std::string_view> with_load_keys(std::vector<std::string_view> others);

}  // namespace counterflex::toml_file
