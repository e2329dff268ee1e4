#pragma once
/// Chains, with what they take from the file's library.
#include "counterflex/machine/machine.hpp"
#include "toml/source.hpp"

namespace counterflex::toml_file {

/// All chains of the document in their order, expanded. Everything that the file defines must be used by one.
std::vector<Chain> read_chains(const toml::table& document, const Source& source);

}  // namespace counterflex::toml_file
