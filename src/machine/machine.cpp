#include "counterflex/machine/machine.hpp"

namespace counterflex {
namespace {

void make_perfect(std::vector<Element>& elements) {
  for (Element& element : elements) {
    if (auto* error = std::get_if<AssemblyError>(&element)) error->X = Pose{};
    if (auto* group = std::get_if<Group>(&element))
      for (Branch& branch : group->branches) make_perfect(branch.elements);
  }
}

void collect(const std::vector<Element>& elements, std::vector<Actuator>& found) {
  for (const Element& element : elements) {
    if (const auto* actuator = std::get_if<Actuator>(&element)) found.push_back(*actuator);
    if (const auto* group = std::get_if<Group>(&element))
      for (const Branch& branch : group->branches) collect(branch.elements, found);
  }
}

}  // namespace

Machine perfect(const Machine& machine) {
  Machine result = machine;
  for (Chain& chain : result.chains) make_perfect(chain.elements);
  return result;
}

std::vector<Actuator> actuators(const Machine& machine) {
  std::vector<Actuator> found;
  for (const Chain& chain : machine.chains) collect(chain.elements, found);
  return found;
}

}  // namespace counterflex
