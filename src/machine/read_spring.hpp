#pragma once
/// Springs of six coordinates as the machine file writes them.
#include "counterflex/machine/machine.hpp"
#include "toml/fields.hpp"

namespace counterflex::toml_file {

/// The table `[springs.NAME]`.
Spring read_spring(const toml::node& node, const std::string& name, const Source& source);

/// The stiffness that `compliance_si` or `stiffness_si` (`form`) gives, positive definite.
Matrix6 read_definite_stiffness(const toml::node& node, std::string_view form, const Source& source);

/// Throws at `node` where `owner` is stiffer than double precision can solve: above 1e14 N/m or N m/rad.
void refuse_too_stiff(double stiffness, std::string_view owner, std::string_view unit, const toml::node& node,
                      const Source& source);

}  // namespace counterflex::toml_file
