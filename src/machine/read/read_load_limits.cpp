#include "machine/read/read_load_limits.hpp"

#include <algorithm>

#include "toml/fields.hpp"

namespace counterflex::toml_file {
namespace {

/// Sets the limits in `table`, and keeps the others in `limits`.
void read_kinds(const toml::table& table, const Source& source, LoadLimits& limits) {
  for (const LoadKind kind : load_kinds) {
    const LoadName& name = name_of(kind);
    if (const toml::node* most = table.get(name.key))
      limits[kind] = as_positive(*most, {name.key}, {source}) * name.si;
  }
}

void read_chain_limits(const toml::table& chain, const Source& source, LoadLimits& limits) {
  const toml::node* node = chain.get("limits");
  if (node == nullptr) return;
  const toml::table& table = as_table(*node, "a chain's limits", source);
  check_keys(table, with_load_keys({}), "a chain's limits", source);
  read_kinds(table, source, limits);
}

}  // namespace

std::vector<std::string_view> with_load_keys(std::vector<std::string_view> others) {
  for (const LoadKind kind : load_kinds) others.push_back(name_of(kind).key);
  return others;
}

void read_load_limits(const toml::table& document, const Source& source, Machine& machine) {
  LoadLimits everywhere;
  if (const toml::node* node = document.get("limits")) read_kinds(*node->as_table(), source, everywhere);
  std::vector<LoadLimits> limits(machine.chains.size(), everywhere);
  for (std::size_t i = 0; i < limits.size(); ++i)
    read_chain_limits(*document.get("chain")->as_array()->get(i)->as_table(), source, limits[i]);
  const bool any = std::any_of(limits.begin(), limits.end(),
                               [](const LoadLimits& chain) { return chain != LoadLimits{}; });
  if (any) machine.load_limits = std::move(limits);
}

}  // namespace counterflex::toml_file
