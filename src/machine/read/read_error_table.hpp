#pragma once
/// Tables of errors of motion, [error_tables.NAME].
#include "counterflex/machine/machine.hpp"
#include "toml/fields.hpp"

namespace counterflex::toml_file {

/// A table, and the kind of joint whose positions it has.
struct KindedTable {
  ErrorTable table;
  JointKind kind = JointKind::prismatic;
};

KindedTable read_error_table(const toml::node& node, const std::string& name, const Source& source);

/// The table that the actuator at `node` uses. Throws there if its positions are of the other kind of joint,
/// or if the actuator's shown value depends on other ones.
const ErrorTable& checked_for(const Actuator& actuator, const KindedTable& found, const toml::node& node,
                              const Source& source);

}  // namespace counterflex::toml_file
