#include "read_tools.hpp"

#include <fmt/format.h>

#include <charconv>

#include "counterflex/geometry/units.hpp"
#include "counterflex/machine/tool.hpp"
#include "fields.hpp"
#include "read_spring.hpp"

namespace counterflex::machine_file {
namespace {

const std::vector<std::string_view> tool_keys = {"length_mm",       "diameter_mm",  "stickout_mm",
                                                 "holder_N_per_um", "stiffness_si", "compliance_si",
                                                 "material"};

/// T3 or 3.
long read_tool_number(const toml::key& key, const Source& source) {
  std::string_view digits = key.str();
  if (digits.starts_with('T') || digits.starts_with('t')) digits.remove_prefix(1);
  long number = -1;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc{} || end != digits.data() + digits.size() || number < 0)
    source.fail(key, fmt::format("\"{}\" is not a tool; it must be T and its number, as T3", key.str()));
  return number;
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
  if (const toml::node* material = table.get("material"))
    if (as_choice(*material, "material", {"carbide", "steel"}, source) == "steel")
      tool.material = ToolMaterial::steel;
  read_stiffness_of(table, name, source, tool);
  return tool;
}

}  // namespace

void read_tools(const toml::table& document, const Source& source, Machine& machine) {
  const toml::node* node = document.get("tools");
  if (node == nullptr) return;
  for (const auto& [key, entry] : as_table(*node, "tools", source)) {
    const long number = read_tool_number(key, source);
    Tool tool = read_one_tool(entry, fmt::format("[tools.{}]", key.str()), source);
    if (!machine.tools.emplace(number, std::move(tool)).second)
      source.fail(key, fmt::format("tool {} stands in the file twice", number));
  }
}

}  // namespace counterflex::machine_file
