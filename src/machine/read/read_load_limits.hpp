#pragma once
/// Reads the allowable loads of the machine and its chains.
#include "counterflex/machine/machine.hpp"
#include "toml/source.hpp"

namespace counterflex::toml_file {

/// Reads [limits], which applies to all chains, and `limits` inside a chain, which overrides it, into
/// `machine`, whose chains have been read. Without limits `load_limits` stays empty.
void read_load_limits(const toml::table& document, const Source& source, Machine& machine);

/// `others`, then the keys of kinds of load.
std::vector<std::string_view> with_load_keys(std::vector<std::string_view> others);

}  // namespace counterflex::toml_file
