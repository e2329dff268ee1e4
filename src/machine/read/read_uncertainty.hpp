#pragma once
#include "counterflex/machine/machine.hpp"
#include "toml/source.hpp"

namespace counterflex::toml_file {

/// Reads [uncertainty] for `machine`, if there is one. The file of its covariance is not read.
std::optional<Uncertainty> read_uncertainty(const toml::table& document, const Source& source,
                                            const Machine& machine);

}  // namespace counterflex::toml_file
