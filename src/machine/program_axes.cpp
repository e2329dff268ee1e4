#include "counterflex/machine/program_axes.hpp"

#include "counterflex/geometry/types.hpp"
#include "machine/walk.hpp"

namespace counterflex {
namespace {

void place(std::vector<Element>& elements, const ProgramAxisValues& values) {
  for (Element& element : elements) {
    if (auto* actuator = std::get_if<Actuator>(&element); actuator != nullptr && actuator->program_axis > 0) {
      const auto& value = values.at(static_cast<std::size_t>(actuator->program_axis - 1));
      if (value) actuator->home = *value * (actuator->joint.kind == JointKind::prismatic ? mm : deg);
    }
    if (auto* group = std::get_if<Group>(&element))
      for (Branch& branch : group->branches) place(branch.elements, values);
  }
}

}  // namespace

std::vector<Actuator> program_axes(const Machine& machine) {
  std::vector<Actuator> axes;
  for_each<Actuator>(machine, [&](const Chain&, const Actuator& actuator) {
    if (actuator.program_axis > 0) axes.push_back(actuator);
  });
  return axes;
}

Machine at_program_axes(const Machine& machine, const ProgramAxisValues& values) {
  Machine placed = machine;
  for (Chain& chain : placed.chains) place(chain.elements, values);
  return placed;
}

}  // namespace counterflex
