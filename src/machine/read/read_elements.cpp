#include "machine/read/read_elements.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "counterflex/geometry/types.hpp"
#include "machine/read/read_joint.hpp"
#include "machine/read/read_transform.hpp"
#include "toml/suggest.hpp"

namespace counterflex::toml_file {
namespace {

constexpr std::size_t most_elements = 10000;
constexpr std::size_t deepest_nesting = 8;

// Solving takes the third power of a chain's coordinates in time, and its wrenches the second of a machine's
// in memory. Measured: `predict` of six lines takes 5 s with 180 coordinates in one chain.
constexpr std::size_t most_in_chain = 180, most_in_machine = 360;

const std::vector<std::string_view> kinds = {"rigid",  "error",      "actuator", "passive",
                                             "spring", "compliance", "parallel"};

Reading reading_of(Expansion& expansion) {
  return {expansion.source, &expansion.fillings};
}

/// The entry called `name`, marked as used. Throws at `node` if it is undefined.
template <class T>
T& use(DefinitionsByName<T>& defined, const std::string& name, std::string_view singular,
       const toml::node& node, const Source& source) {
  const auto found = defined.find(name);
  if (found == defined.end())
    source.fail(
        node, fmt::format("there is no {} \"{}\"{}", singular, name, hint(name, names(defined), "defined")));
  found->second.used = true;
  return found->second.value;
}

Element read_rigid(const toml::table& table, Expansion& expansion) {
  const toml::node& node = *table.get("rigid");
  check_keys(table, {"rigid", "mass"}, "a rigid element", expansion.source);
  if (!node.is_string()) return Rigid{read_transform(node, "rigid", reading_of(expansion))};
  const std::string name = as_text(node, "rigid", expansion.source);
  Fillings& fillings = expansion.fillings;
  const auto found = fillings.transforms.find(name);
  if (found == fillings.transforms.end())
    expansion.source.fail(*fillings.place,
                          fmt::format("chain \"{}\" lacks transforms.{}, which its elements use in line {}",
                                      fillings.chain, name, node.source().begin.line));
  found->second.used = true;
  return Rigid{found->second.value};
}

Element read_error(const toml::table& table, Expansion& expansion) {
  const toml::node& node = *table.get("error");
  check_keys(table, {"error", "mass"}, "an error slot", expansion.source);
  const std::string name = as_text(node, "error", expansion.source);
  if (!expansion.slots.insert(name).second)
    expansion.source.fail(
        node,
        fmt::format("chain \"{}\" has the error slot \"{}\" twice; each slot of a chain needs its own name",
                    expansion.fillings.chain, name));
  const auto given = expansion.fillings.errors.find(name);
  if (given == expansion.fillings.errors.end()) return AssemblyError{name, Pose{}};
  given->second.used = true;
  return AssemblyError{name, given->second.value};
}

Element read_actuator_element(const toml::table& table, Expansion& expansion) {
  const Source& source = expansion.source;
  Actuator actuator = read_actuator(table, reading_of(expansion), expansion.library.actuators);
  if (expansion.library.actuators.kinds.size() > most_actuators)
    source.fail(
        *table.get("actuator"),
        fmt::format("the machine has more than {0} actuators; at most {0} are allowed", most_actuators));
  if (const toml::node* node = table.get("error_table")) {
    const std::string name = as_text(*node, "error_table", source);
    actuator.errors = checked_for(
        actuator, use(expansion.library.error_tables, name, "error table", *node, source), *node, source);
  }
  return actuator;
}

Element read_spring_element(const toml::table& table, Expansion& expansion) {
  const toml::node& node = *table.get("spring");
  check_keys(table, {"spring", "mass"}, "a spring element", expansion.source);
  return use(expansion.library.springs, as_text(node, "spring", expansion.source), "spring", node,
             expansion.source);
}

Branch read_branch(const toml::node& node, Expansion& expansion) {
  const std::string name = as_text(node, "a branch's name", expansion.source);
  const toml::node& list = *use(expansion.library.branches, name, "branch", node, expansion.source);
  std::vector<std::string>& open = expansion.open_branches;
  if (std::find(open.begin(), open.end(), name) != open.end())
    expansion.source.fail(
        node, fmt::format("branch \"{}\" is part of itself: {} > {}", name, fmt::join(open, " > "), name));
  if (open.size() == deepest_nesting)
    expansion.source.fail(node,
                          fmt::format("branch \"{}\" is more than {} branches deep", name, deepest_nesting));
  open.push_back(name);
  count_coordinates(6, node, expansion);
  Branch branch{name, read_elements(list, expansion)};
  open.pop_back();
  return branch;
}

Element read_group(const toml::table& table, Expansion& expansion) {
  const toml::node& node = *table.get("parallel");
  check_keys(table, {"parallel", "mass"}, "a parallel element", expansion.source);
  const toml::array& list = as_array(node, "parallel", expansion.source);
  if (list.empty()) expansion.source.fail(node, "parallel is empty; it must list the branches");
  Group group;
  for (const toml::node& name : list) group.branches.push_back(read_branch(name, expansion));
  return group;
}

PointMass read_mass(const toml::node& node, const Reading& reading) {
  const toml::table& table = as_table(node, "mass", reading.source);
  check_keys(table, {"kg", "at_mm", "name"}, "a mass", reading.source);
  PointMass mass;
  mass.kg = as_positive(required(table, "kg", "a mass", node, reading.source), {"kg"}, reading);
  if (const toml::node* at = table.get("at_mm")) mass.at = as_vector3(*at, "at_mm", reading) * mm;
  if (const toml::node* name = table.get("name")) mass.name = as_identifier(*name, "name", reading.source);
  return mass;
}

[[noreturn]] void fail_without_kind(const toml::table& table, const Source& source) {
  std::vector<std::string_view> allowed = kinds;
  allowed.push_back("mass");
  check_keys(table, allowed, "an element", source);
  source.fail(table, fmt::format("{} one of {}",
                                 table.empty() ? "an element is empty; it must be"
                                               : "a mass is alone in its entry; add it to",
                                 fmt::join(kinds, ", ")));
}

Element read_element(const toml::table& table, Expansion& expansion) {
  const Source& source = expansion.source;
  const std::string_view kind = one_of(table, kinds, "an element", source);
  if (kind.empty()) fail_without_kind(table, source);
  if (kind == "rigid") return read_rigid(table, expansion);
  if (kind == "error") return read_error(table, expansion);
  if (kind == "actuator") return read_actuator_element(table, expansion);
  if (kind == "passive") return read_passive(table, reading_of(expansion));
  if (kind == "spring") return read_spring_element(table, expansion);
  if (kind == "compliance") return read_compliance(table, reading_of(expansion));
  return read_group(table, expansion);
}

std::size_t coordinates_of(const Element& element) {
  if (std::holds_alternative<Spring>(element) || std::holds_alternative<Group>(element)) return 6;
  const bool is_joint = std::holds_alternative<Actuator>(element) ||
                        std::holds_alternative<Passive>(element) ||
                        std::holds_alternative<Compliance>(element);
  return is_joint ? 1 : 0;
}

}  // namespace

void count_coordinates(std::size_t count, const toml::node& node, Expansion& expansion) {
  const auto limit = [&](std::size_t found, std::string_view whole, std::size_t most) {
    if (found <= most) return;
    expansion.source.fail(
        node, fmt::format("here, in chain \"{}\", {} has more than {} coordinates (6 a spring, parallel "
                          "element, branch and "
                          "chain, 1 a joint); at most {} are allowed: put springs in series into one",
                          expansion.fillings.chain, whole, most, most));
  };
  limit(expansion.coordinates += count, "the chain", most_in_chain);
  limit(expansion.library.coordinates += count, "the machine", most_in_machine);
}

std::vector<Element> read_elements(const toml::node& node, Expansion& expansion) {
  const toml::array& list = as_array(node, "elements", expansion.source);
  if (list.empty()) expansion.source.fail(node, "elements is empty; a list has at least one element");
  std::vector<Element> elements;
  elements.reserve(list.size());
  for (const toml::node& element : list) {
    if (++expansion.library.elements > most_elements)
      expansion.source.fail(
          element,
          fmt::format(
              "here, in chain \"{}\", the machine has more than {} elements; branches that use branches "
              "multiply",
              expansion.fillings.chain, most_elements));
    const toml::table& table = as_table(element, "an element", expansion.source);
    elements.push_back(read_element(table, expansion));
    count_coordinates(coordinates_of(elements.back()), element, expansion);
    if (const toml::node* mass = table.get("mass"))
      elements.push_back(read_mass(*mass, reading_of(expansion)));
  }
  return elements;
}

}  // namespace counterflex::toml_file
