#pragma once
/// What a machine file defines once for its chains to use.
#include "counterflex/machine/machine.hpp"
#include "toml/fields.hpp"

namespace counterflex::toml_file {

/// Springs are read at once; branches and templates are kept as nodes, for each chain fills them with its own
/// numbers.
struct Library {
  GivenByName<Spring> springs;
  GivenByName<const toml::node*> branches;
  GivenByName<const toml::node*> templates;
  std::size_t elements = 0;     ///< of all chains so far
  std::size_t coordinates = 0;  ///< of all chains so far, see `read_elements`
};

/// Reads the tables `springs`, `branches` and `templates`.
Library read_library(const toml::table& document, const Source& source);

/// Throws at the first definition that no chain uses.
void check_all_used(const Library& library, const Source& source);

/// The names in `given`, for hints.
template <class T>
std::vector<std::string_view> names(const GivenByName<T>& given) {
  std::vector<std::string_view> list;
  for (const auto& [name, entry] : given) list.push_back(name);
  return list;
}

/// The key of the first entry, in the order of the file, that nothing used; null where all are used.
template <class T>
const toml::key* first_unused(const GivenByName<T>& given) {
  const toml::key* first = nullptr;
  for (const auto& [name, entry] : given)
    if (!entry.used && (first == nullptr || before(entry.key->source(), first->source()))) first = entry.key;
  return first;
}

}  // namespace counterflex::toml_file
