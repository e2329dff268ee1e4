#include "machine/read/read_chains.hpp"

#include <fmt/format.h>

#include "counterflex/files/text.hpp"
#include "machine/read/read_elements.hpp"
#include "machine/read/read_transform.hpp"
#include "toml/suggest.hpp"

namespace counterflex::toml_file {
namespace {

/// The entries of the chain's table `kind` (`values`, `transforms`, `errors`), each read by `read(node,
/// name)`.
template <class T, class Read>
DefinitionsByName<T> read_given(const toml::table& chain, std::string_view kind, const Source& source,
                                const Read& read) {
  DefinitionsByName<T> given;
  const toml::node* node = chain.get(kind);
  if (node == nullptr) return given;
  for (const auto& [key, value] : as_table(*node, kind, source)) {
    const std::string name = fmt::format("{}.{}", kind, key.str());
    given[std::string(key.str())] = {read(value, name), &key};
  }
  return given;
}

Fillings read_fillings(const toml::table& chain, std::string name, const toml::node& place,
                       const Source& source) {
  const Reading plain{source};
  const auto pose = [&](const toml::node& node, const std::string& what) {
    return read_transform(node, what, plain);
  };
  const auto number = [&](const toml::node& node, const std::string& what) {
    return as_number(node, {what}, plain);
  };
  return {std::move(name), &place, read_given<double>(chain, "values", source, number),
          read_given<Pose>(chain, "transforms", source, pose),
          read_given<Pose>(chain, "errors", source, pose)};
}

template <class T>
void check_used(const DefinitionsByName<T>& given, std::string_view kind, const std::string& chain,
                const Source& source, const std::string& remedy) {
  if (const toml::key* unused = first_unused(given))
    source.fail(*unused,
                fmt::format("chain \"{}\" does not use {}.{}{}", chain, kind, unused->str(), remedy));
}

void check_fillings_used(const Expansion& expansion) {
  const Fillings& fillings = expansion.fillings;
  const Source& source = expansion.source;
  check_used(fillings.values, "values", fillings.chain, source, "; no number of its elements refers to it");
  check_used(fillings.transforms, "transforms", fillings.chain, source, "; no rigid element refers to it");
  if (const toml::key* unused = first_unused(fillings.errors)) {
    const std::vector<std::string_view> slots(expansion.slots.begin(), expansion.slots.end());
    check_used(fillings.errors, "errors", fillings.chain, source, hint(unused->str(), slots, "error slots"));
  }
}

/// The list of elements that the chain uses or gives.
const toml::node& read_list(const toml::table& chain, const std::string& owner, Library& library,
                            const Source& source) {
  const std::string_view form = one_of(chain, {"use", "elements"}, owner, source);
  if (form.empty()) source.fail(chain, fmt::format("{} has neither \"use\" nor \"elements\"", owner));
  const toml::node& node = *chain.get(form);
  if (form == "elements") return node;
  const std::string name = as_text(node, "use", source);
  const auto found = library.templates.find(name);
  if (found == library.templates.end())
    source.fail(node, fmt::format("there is no template \"{}\"{}", name,
                                  hint(name, names(library.templates), "defined")));
  found->second.used = true;
  return *found->second.value;
}

Chain read_chain(const toml::table& table, Library& library, const Source& source) {
  check_keys(table,
             {"name", "base", "use", "elements", "platform", "errors", "transforms", "values", "limits"},
             "a chain", source);
  Chain chain;
  chain.name = without_controls(as_text(required(table, "name", "a chain", table, source), "name", source));
  const toml::node& list = read_list(table, fmt::format("chain \"{}\"", chain.name), library, source);
  const toml::node& place = table.contains("use") ? *table.get("use") : list;
  Fillings fillings = read_fillings(table, chain.name, place, source);
  Expansion expansion{source, library, fillings, {}, {}};
  count_coordinates(6, table, expansion);
  if (const toml::node* base = table.get("base"))
    chain.elements.push_back(Rigid{read_transform(*base, "base", {source})});
  for (Element& element : read_elements(list, expansion)) chain.elements.push_back(std::move(element));
  if (const toml::node* platform = table.get("platform"))
    chain.elements.push_back(Rigid{read_transform(*platform, "platform", {source})});
  check_fillings_used(expansion);
  return chain;
}

const toml::array& chain_tables(const toml::table& document, const Source& source) {
  const toml::node* node = document.get("chain");
  if (node == nullptr) source.fail_at_start("the file has no [[chain]]; a machine has at least one");
  if (!node->is_array())
    source.fail(*node,
                fmt::format("chain must be a list of tables, each begun by [[chain]], not {}", seen(*node)));
  if (node->as_array()->empty()) source.fail(*node, "chain is empty; a machine has at least one chain");
  return *node->as_array();
}

}  // namespace

std::vector<Chain> read_chains(const toml::table& document, const Source& source) {
  Library library = read_library(document, source);
  std::vector<Chain> chains;
  for (const toml::node& node : chain_tables(document, source)) {
    const toml::table& table = as_table(node, "a chain", source);
    Chain chain = read_chain(table, library, source);
    for (const Chain& other : chains)
      if (other.name == chain.name)
        source.fail(*table.get("name"),
                    fmt::format("two chains are called \"{}\"; names of chains must differ", chain.name));
    chains.push_back(std::move(chain));
  }
  check_all_used(library, source);
  return chains;
}

}  // namespace counterflex::toml_file
