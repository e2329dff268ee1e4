#pragma once
/// Visits every element of a machine.
#include "counterflex/machine/machine.hpp"

namespace counterflex {

/// Calls `visit(element)` for each element in order; after a group, its branches' elements.
template <class Visit>
void for_each_element(const std::vector<Element>& elements, const Visit& visit) {
  for (const Element& element : elements) {
    visit(element);
    if (const auto* group = std::get_if<Group>(&element))
      for (const Branch& branch : group->branches) for_each_element(branch.elements, visit);
  }
}

/// Calls `visit(chain, part)` for each element of type `Part`.
template <class Part, class Visit>
void for_each(const Machine& machine, const Visit& visit) {
  for (const Chain& chain : machine.chains)
    for_each_element(chain.elements, [&](const Element& element) {
      if (const auto* part = std::get_if<Part>(&element)) visit(chain, *part);
    });
}

/// Each spring of the machine once, in the order of the chains.
std::vector<const Spring*> distinct_springs(const Machine& machine);

}  // namespace counterflex
