#pragma once
/// Cutting coefficients in TOML.
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/forces/cutting_model.hpp"
#include "toml/fields.hpp"

namespace counterflex::force_file {

/// The coefficients in a table; `others` are further keys that it may have. Throws if a unit is missing.
CuttingCoefficients read_coefficients(const toml::node& node, std::string_view owner,
                                      const std::vector<std::string_view>& others,
                                      const toml_file::Source& source);

using Materials = std::map<std::string, CuttingCoefficients, std::less<>>;

/// The coefficients of the table `materials`, and published ones of other names.
Materials read_materials(const toml::table& document, const toml_file::Source& source);

/// The text of `coefficients.toml`.
std::string_view published_toml();

}  // namespace counterflex::force_file
