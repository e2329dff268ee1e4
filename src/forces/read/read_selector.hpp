#pragma once
/// Reads the selector of a rule: the moves that it covers.
#include "counterflex/forces/cutting_model.hpp"
#include "toml/fields.hpp"

namespace counterflex::force_file {

/// Reads the optional keys `tool`, `op`, `lines` and `blocks` of a table.
ForceSelector read_selector(const toml::table& table, const toml_file::Source& source);

}  // namespace counterflex::force_file
