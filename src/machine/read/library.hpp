#pragma once
/// Definitions of a machine file that its chains share.
#include "counterflex/machine/machine.hpp"
#include "machine/read/read_error_table.hpp"
#include "machine/read/read_shown.hpp"
#include "toml/fields.hpp"

namespace counterflex::toml_file {

/// Springs and error tables are read at once. Branches and templates are kept as nodes, because each chain
/// fills in its own numbers.
struct Library {
  DefinitionsByName<Spring> springs;
  DefinitionsByName<KindedTable> error_tables;
  DefinitionsByName<const toml::node*> branches;
  DefinitionsByName<const toml::node*> templates;
  ActuatorsBefore actuators;    ///< of all chains so far
  std::size_t elements = 0;     ///< of all chains so far
  std::size_t coordinates = 0;  ///< of all chains so far, see `read_elements`
};

/// Reads the tables `springs`, `error_tables`, `branches` and `templates`.
Library read_library(const toml::table& document, const Source& source);

/// Throws at the first unused definition.
void check_all_used(const Library& library, const Source& source);

/// The names in `given`, for hints.
template <class T>
std::vector<std::string_view> names(const DefinitionsByName<T>& given) {
  std::vector<std::string_view> list;
  for (const auto& [name, entry] : given) list.push_back(name);
  return list;
}

/// The key of the first unused entry, in the order of the file; null if all are used.
template <class T>
const toml::key* first_unused(const DefinitionsByName<T>& given) {
  const toml::key* first = nullptr;
  for (const auto& [name, entry] : given)
    if (!entry.used && (first == nullptr || before(entry.key->source(), first->source()))) first = entry.key;
  return first;
}

}  // namespace counterflex::toml_file
