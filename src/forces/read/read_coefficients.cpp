#include "forces/read/read_coefficients.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "counterflex/forces/cutting_model.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace force_file {
namespace {

using namespace toml_file;

struct Coefficient {
  std::string_view name, key;
  double CuttingCoefficients::*value;
  double unit;
  double most;  ///< in that unit; larger values have a wrong unit
};

constexpr std::array<Coefficient, 6> coefficients = {
    {{"Ktc", "Ktc_N_mm2", &CuttingCoefficients::K_tc, N_per_mm2, 1e5},
     {"Krc", "Krc_N_mm2", &CuttingCoefficients::K_rc, N_per_mm2, 1e5},
     {"Kac", "Kac_N_mm2", &CuttingCoefficients::K_ac, N_per_mm2, 1e5},
     {"Kte", "Kte_N_mm", &CuttingCoefficients::K_te, N_per_mm, 1e4},
     {"Kre", "Kre_N_mm", &CuttingCoefficients::K_re, N_per_mm, 1e4},
     {"Kae", "Kae_N_mm", &CuttingCoefficients::K_ae, N_per_mm, 1e4}}};

void check_units(const toml::table& table, const Source& source) {
  for (const Coefficient& coefficient : coefficients)
    if (table.contains(coefficient.name))
      source.fail(
          key_of(table, coefficient.name),
          fmt::format("\"{}\" is a coefficient without unit; write {}", coefficient.name, coefficient.key));
}

}  // namespace

CuttingCoefficients read_coefficients(const toml::node& node, std::string_view owner,
                                      const std::vector<std::string_view>& others, const Source& source) {
  const toml::table& table = as_table(node, owner, source);
  check_units(table, source);
  std::vector<std::string_view> allowed;
  for (const Coefficient& coefficient : coefficients) allowed.push_back(coefficient.key);
  allowed.insert(allowed.end(), others.begin(), others.end());
  check_keys(table, allowed, owner, source);
  as_positive(required(table, "Ktc_N_mm2", owner, node, source), {"Ktc_N_mm2"}, {source});
  required(table, "Krc_N_mm2", owner, node, source);
  CuttingCoefficients read;
  for (const Coefficient& coefficient : coefficients)
    if (const toml::node* value = table.get(coefficient.key))
      read.*coefficient.value =
          as_between(*value, {coefficient.key}, -coefficient.most, coefficient.most, source) *
          coefficient.unit;
  return read;
}

Materials read_materials(const toml::table& document, const Source& source) {
  Materials materials;
  if (const toml::node* node = document.get("materials"))
    for (const auto& [key, entry] : as_table(*node, "materials", source)) {
      const std::string owner = fmt::format("[materials.{}]", key.str());
      materials.emplace(key.str(), read_coefficients(entry, owner, {}, source));
    }
  for (const PublishedCoefficients& published : published_coefficients())
    materials.emplace(published.name, published.coefficients);
  return materials;
}

namespace {

std::vector<PublishedCoefficients> read_published() {
  const Source source(published_toml(), "coefficients.toml");
  const toml::table document = source.parse();
  std::vector<const toml::key*> keys;
  for (const auto& [key, entry] : document) keys.push_back(&key);
  std::sort(keys.begin(), keys.end(),
            [](const auto* a, const auto* b) { return before(a->source(), b->source()); });
  std::vector<PublishedCoefficients> published;
  for (const toml::key* key : keys) {
    const toml::node& entry = *document.get(key->str());
    const auto text = [&](std::string_view name) {
      return as_text(required(*entry.as_table(), name, key->str(), entry, source), name, source);
    };
    const CuttingCoefficients read =
        read_coefficients(entry, key->str(), {"material", "cutter", "source"}, source);
    published.push_back({std::string(key->str()), text("material"), text("cutter"), text("source"), read});
  }
  return published;
}

}  // namespace
}  // namespace force_file

const std::vector<PublishedCoefficients>& published_coefficients() {
  static const std::vector<PublishedCoefficients> published = force_file::read_published();
  return published;
}

}  // namespace counterflex
