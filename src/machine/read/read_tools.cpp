#include "machine/read/read_tools.hpp"

#include <fmt/format.h>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/machine.hpp"
#include "machine/read/read_spring.hpp"
#include "toml/fields.hpp"

namespace counterflex::toml_file {
namespace {

const std::vector<std::string_view> tool_keys = {"length_mm",     "diameter_mm",     "stickout_mm",
                                                 "flute_mm",      "holder_N_per_um", "stiffness_si",
                                                 "compliance_si", "material",        "mass"};

/// T3 or 3.
long number_of(const toml::key& key, const Source& source) {
  const std::optional<long> number = read_tool_number(key.str());
  if (!number)
    source.fail(key, fmt::format("\"{}\" is not a tool; it must be T and its number, as T3", key.str()));
  return *number;
}

std::optional<double> read_length(const toml::table& table, std::string_view key, const Source& source) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return std::nullopt;
  return as_positive(*node, {key}, {source}) * mm;
}

void read_cantilever(const toml::table& table, const std::string& name, const Source& source, Tool& tool) {
  if (!tool.stickout) return;
  if (!tool.diameter)
    source.fail(
        key_of(table, "stickout_mm"),
        fmt::format("{} has \"stickout_mm\" without \"diameter_mm\"; its stiffness needs both, or give one "
                    "of holder_N_per_um, stiffness_si, compliance_si",
                    name));
  tool.from = ToolStiffness::cantilever;
  tool.yields = {cantilever_tool(*tool.diameter, *tool.stickout, tool.material)};
}

void read_stiffness_of(const toml::table& table, const std::string& name, const Source& source, Tool& tool) {
  const std::string_view form =
      one_of(table, {"holder_N_per_um", "stiffness_si", "compliance_si"}, name, source);
  if (form.empty()) return read_cantilever(table, name, source, tool);
  const toml::node& node = *table.get(form);
  if (form == "holder_N_per_um") {
    tool.from = ToolStiffness::radial;
    tool.yields = radial_tool(as_positive(node, {form}, {source}) * N_per_um);
    return;
  }
  tool.from = ToolStiffness::matrix;
  tool.yields = {Spring{"tool", read_definite_stiffness(node, form, source)}};
}

/// Tool number 0 belongs to moves before any tool is called: values other than the length of G43 H0 would
/// have no effect.
void refuse_no_tool(const toml::table& table, const std::string& name, const Source& source) {
  for (const auto& [key, unused] : table)
    if (key.str() != "length_mm")
      source.fail(key, fmt::format("{} has \"{}\", but tool 0 means no known tool, which [tool] describes; "
                                   "only \"length_mm\" is allowed",
                                   name, key.str()));
}

Tool read_one_tool(const toml::node& node, const std::string& name, const Source& source) {
  const toml::table& table = as_table(node, name, source);
  check_keys(table, tool_keys, name, source);
  if (table.empty())
    source.fail(
        node, fmt::format("{} is empty; it must have at least one of {}", name, fmt::join(tool_keys, ", ")));
  Tool tool;
  if (const toml::node* length = table.get("length_mm"))
    tool.length = as_number(*length, {"length_mm"}, {source}) * mm;
  tool.diameter = read_length(table, "diameter_mm", source);
  tool.stickout = read_length(table, "stickout_mm", source);
  tool.flute = read_length(table, "flute_mm", source);
  if (tool.flute && tool.stickout && *tool.flute > *tool.stickout)
    source.fail(*table.get("flute_mm"), fmt::format("flute_mm is {:.6g}, must be at most stickout_mm, {:.6g}",
                                                    *tool.flute / mm, *tool.stickout / mm));
  if (const toml::node* material = table.get("material"))
    if (as_choice(*material, "material", {"carbide", "steel"}, source) == "steel")
      tool.material = ToolMaterial::steel;
  if (const toml::node* mass = table.get("mass")) tool.mass = read_tool_mass(*mass, source);
  read_stiffness_of(table, name, source, tool);
  return tool;
}

}  // namespace

PointMass read_tool_mass(const toml::node& node, const Source& source) {
  const toml::table& table = as_table(node, "mass", source);
  check_keys(table, {"kg", "at_mm"}, "the mass of a tool", source);
  PointMass mass;
  mass.name = "tool";
  mass.kg = as_positive(required(table, "kg", "the mass of a tool", node, source), {"kg"}, {source});
  if (const toml::node* at = table.get("at_mm")) mass.at = as_vector3(*at, "at_mm", {source}) * mm;
  return mass;
}

void read_tools(const toml::table& document, const Source& source, Machine& machine) {
  const toml::node* node = document.get("tools");
  if (node == nullptr) return;
  for (const auto& [key, entry] : as_table(*node, "tools", source)) {
    const long number = number_of(key, source);
    const std::string name = fmt::format("[tools.{}]", key.str());
    Tool tool = read_one_tool(entry, name, source);
    if (number == 0) refuse_no_tool(*entry.as_table(), name, source);
    if (!machine.tools.emplace(number, std::move(tool)).second)
      source.fail(key, fmt::format("tool {} is defined twice", number));
  }
}

}  // namespace counterflex::toml_file
