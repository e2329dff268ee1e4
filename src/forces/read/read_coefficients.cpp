#include "forces/read/read_coefficients.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

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

// Kienzle's law.
constexpr double largest_kc11 = 1e5;  // N/mm2
constexpr double largest_mc = 0.9, largest_share = 10;

bool is_kienzle(const toml::table& table) {
  return table.contains("kc11_N_mm2") || table.contains("mc") || table.contains("radial_share") ||
         table.contains("axial_share");
}

void refuse_both_laws(const toml::table& table, std::string_view owner, const Source& source) {
  for (const Coefficient& coefficient : coefficients)
    if (table.contains(coefficient.key))
      source.fail(key_of(table, coefficient.key),
                  fmt::format("{} has both {} and Kienzle's keys; give either Ktc_N_mm2 and the others, or "
                              "kc11_N_mm2, mc, radial_share and axial_share",
                              owner, coefficient.key));
}

Material read_kienzle(const toml::table& table, std::string_view owner, const toml::node& node,
                      const Source& source) {
  refuse_both_laws(table, owner, source);
  const toml::node& main = required(table, "kc11_N_mm2", owner, node, source);
  as_positive(main, {"kc11_N_mm2"}, {source});
  const double kc11 = as_between(main, {"kc11_N_mm2"}, 0, largest_kc11, source) * N_per_mm2;
  Material material{.is_kienzle = true};
  material.coefficients.m_c =
      as_between(required(table, "mc", owner, node, source), {"mc"}, 0, largest_mc, source);
  material.coefficients.K_tc = kc11 * std::pow(mm, material.coefficients.m_c);
  if (const toml::node* share = table.get("radial_share"))
    material.radial_share = read_share(*share, "radial_share", source);
  if (const toml::node* share = table.get("axial_share"))
    material.axial_share = read_share(*share, "axial_share", source);
  return material;
}

}  // namespace

double read_share(const toml::node& node, std::string_view key, const Source& source) {
  return as_between(node, {key}, -largest_share, largest_share, source);
}

Material read_material(const toml::node& node, std::string_view owner,
                       const std::vector<std::string_view>& others, const Source& source) {
  const toml::table& table = as_table(node, owner, source);
  check_units(table, source);
  std::vector<std::string_view> allowed;
  for (const Coefficient& coefficient : coefficients) allowed.push_back(coefficient.key);
  allowed.insert(allowed.end(), {"kc11_N_mm2", "mc", "radial_share", "axial_share"});
  allowed.insert(allowed.end(), others.begin(), others.end());
  check_keys(table, allowed, owner, source);
  if (is_kienzle(table)) return read_kienzle(table, owner, node, source);
  as_positive(required(table, "Ktc_N_mm2", owner, node, source), {"Ktc_N_mm2"}, {source});
  required(table, "Krc_N_mm2", owner, node, source);
  Material material;
  for (const Coefficient& coefficient : coefficients)
    if (const toml::node* value = table.get(coefficient.key))
      material.coefficients.*coefficient.value =
          as_between(*value, {coefficient.key}, -coefficient.most, coefficient.most, source) *
          coefficient.unit;
  return material;
}

Materials read_materials(const toml::table& document, const Source& source) {
  Materials materials;
  if (const toml::node* node = document.get("materials"))
    for (const auto& [key, entry] : as_table(*node, "materials", source)) {
      const std::string owner = fmt::format("[materials.{}]", key.str());
      materials.emplace(key.str(), read_material(entry, owner, {}, source));
    }
  for (const PublishedCoefficients& published : published_coefficients())
    materials.emplace(published.name, Material{published.coefficients, published.coefficients.m_c > 0});
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
    const Material read = read_material(entry, key->str(), {"material", "cutter", "source"}, source);
    published.push_back(
        {std::string(key->str()), text("material"), text("cutter"), text("source"), read.coefficients});
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
