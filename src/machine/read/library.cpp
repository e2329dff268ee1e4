#include "machine/read/library.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "machine/read/read_spring.hpp"

namespace counterflex::toml_file {
namespace {

/// Calls `add(name, key, node)` for each entry of the table under `kind`, in the order of the file.
template <class Add>
void for_each_definition(const toml::table& document, std::string_view kind, const Source& source,
                         const Add& add) {
  const toml::node* node = document.get(kind);
  if (node == nullptr) return;
  std::vector<std::pair<const toml::key*, const toml::node*>> entries;
  for (const auto& [key, value] : as_table(*node, kind, source)) entries.emplace_back(&key, &value);
  std::sort(entries.begin(), entries.end(),
            [](const auto& a, const auto& b) { return before(a.first->source(), b.first->source()); });
  for (const auto& [key, value] : entries) add(std::string(key->str()), key, *value);
}

DefinitionsByName<const toml::node*> read_element_lists(const toml::table& document, std::string_view kind,
                                                        std::string_view singular, const Source& source) {
  DefinitionsByName<const toml::node*> lists;
  for_each_definition(document, kind, source,
                      [&](std::string name, const toml::key* key, const toml::node& node) {
                        const std::string owner = fmt::format("{} \"{}\"", singular, name);
                        const toml::table& table = as_table(node, owner, source);
                        check_keys(table, {"elements"}, owner, source);
                        lists[std::move(name)] = {&required(table, "elements", owner, node, source), key};
                      });
  return lists;
}

template <class T>
void check_used(const DefinitionsByName<T>& given, std::string_view singular, const Source& source) {
  if (const toml::key* unused = first_unused(given))
    source.fail(*unused, fmt::format("no chain uses the {} \"{}\"; remove it", singular, unused->str()));
}

}  // namespace

Library read_library(const toml::table& document, const Source& source) {
  Library library;
  for_each_definition(document, "springs", source,
                      [&](std::string name, const toml::key* key, const toml::node& node) {
                        library.springs[name] = {read_spring(node, name, source), key};
                      });
  for_each_definition(document, "error_tables", source,
                      [&](std::string name, const toml::key* key, const toml::node& node) {
                        library.error_tables[name] = {read_error_table(node, name, source), key};
                      });
  library.branches = read_element_lists(document, "branches", "branch", source);
  library.templates = read_element_lists(document, "templates", "template", source);
  return library;
}

void check_all_used(const Library& library, const Source& source) {
  check_used(library.templates, "template", source);
  check_used(library.branches, "branch", source);
  check_used(library.springs, "spring", source);
  check_used(library.error_tables, "error table", source);
}

}  // namespace counterflex::toml_file
