#include "machine/read/read_uncertainty.hpp"

#include "counterflex/geometry/types.hpp"
#include "toml/fields.hpp"

namespace counterflex::toml_file {

std::optional<Uncertainty> read_uncertainty(const toml::table& document, const Source& source,
                                            const Machine& machine) {
  const toml::node* node = document.get("uncertainty");
  if (node == nullptr) return std::nullopt;
  const toml::table& table = as_table(*node, "[uncertainty]", source);
  check_keys(table, {"covariance", "force_percent", "tool_length_um", "repeatability_um", "temperature_K"},
             "[uncertainty]", source);
  Uncertainty uncertainty;
  const auto read = [&](std::string_view key, double unit, double& value) {
    if (const toml::node* given = table.get(key)) value = as_not_negative(*given, {key}, {source}) * unit;
  };
  read("force_percent", 0.01, uncertainty.force);
  read("tool_length_um", um, uncertainty.tool_length);
  read("repeatability_um", um, uncertainty.repeatability);
  read("temperature_K", 1, uncertainty.temperature);
  if (const toml::node* path = table.get("covariance")) {
    uncertainty.covariance = as_text(*path, "covariance", source);
    uncertainty.covariance_at = source.at(path->source());
    if (uncertainty.covariance.empty())
      source.fail(*path, "covariance is empty; it must be the path of a STEM.json of identify --report");
  }
  if (const toml::node* kelvin = table.get("temperature_K")) {
    uncertainty.temperature_at = source.at(kelvin->source());
    if (uncertainty.temperature > 0 && !machine.thermal)
      source.fail(*kelvin, "temperature_K needs [thermal]: the shift of the tip by temperature");
  }
  return uncertainty;
}

}  // namespace counterflex::toml_file
