#pragma once
/// Reads springs of six coordinates from the machine file.
#include "counterflex/machine/machine.hpp"
#include "toml/fields.hpp"

namespace counterflex::toml_file {

/// The table `[springs.NAME]`.
Spring read_spring(const toml::node& node, const std::string& name, const Source& source);

/// The stiffness from `compliance_si` or `stiffness_si` (`form`), positive definite.
Matrix6 read_definite_stiffness(const toml::node& node, std::string_view form, const Source& source);

/// Throws at `node` if `owner` is too stiff for double precision: above 1e14 N/m or N m/rad.
void refuse_too_stiff(double stiffness, std::string_view owner, std::string_view unit, const toml::node& node,
                      const Source& source);

}  // namespace counterflex::toml_file
