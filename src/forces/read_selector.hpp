#pragma once
/// Which moves a rule covers, as a table says it.
#include "counterflex/forces/cutting_model.hpp"
#include "toml/fields.hpp"

namespace counterflex::force_file {

/// The keys `tool`, `op`, `lines` and `blocks` of a table, those of them that it has.
ForceSelector read_selector(const toml::table& table, const toml_file::Source& source);

}  // namespace counterflex::force_file
