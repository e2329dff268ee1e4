#pragma once
/// Cutting coefficients in TOML.
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/forces/cutting_model.hpp"
#include "toml/fields.hpp"

namespace counterflex::force_file {

/// A material: its coefficients, or Kienzle's kc1.1 and mc, of which the shares may be left to the section.
struct Material {
  CuttingCoefficients coefficients;
  bool is_kienzle = false;
  std::optional<double> radial_share{}, axial_share{};  ///< K_rc and K_ac over K_tc, of Kienzle's law only
};

/// The material in a table; `others` are further keys that it may have. Throws if a unit is missing.
Material read_material(const toml::node& node, std::string_view owner,
                       const std::vector<std::string_view>& others, const toml_file::Source& source);

/// A share of the tangential force, -10 to 10.
double read_share(const toml::node& node, std::string_view key, const toml_file::Source& source);

using Materials = std::map<std::string, Material, std::less<>>;

/// The coefficients of the table `materials`, and published ones of other names.
Materials read_materials(const toml::table& document, const toml_file::Source& source);

/// The text of `coefficients.toml`.
std::string_view published_toml();

}  // namespace counterflex::force_file
