#include "counterflex/machine/machine.hpp"

#include <algorithm>
#include <cmath>

#include "machine/walk.hpp"

namespace counterflex {
namespace {

void make_perfect(std::vector<Element>& elements) {
  for (Element& element : elements) {
    if (auto* error = std::get_if<AssemblyError>(&element)) error->X = Pose{};
    if (auto* actuator = std::get_if<Actuator>(&element))
      actuator->errors.reset(), actuator->reversal.reset(), actuator->harmonics.clear();
    if (auto* group = std::get_if<Group>(&element))
      for (Branch& branch : group->branches) make_perfect(branch.elements);
  }
}

void collect(const std::vector<Element>& elements, std::vector<Actuator>& found) {
  for (const Element& element : elements) {
    const auto* actuator = std::get_if<Actuator>(&element);
    if (actuator != nullptr && actuator->program_axis == 0) found.push_back(*actuator);
    if (const auto* group = std::get_if<Group>(&element))
      for (const Branch& branch : group->branches) collect(branch.elements, found);
  }
}

}  // namespace

double largest_harmonic(const Actuator& actuator) {
  double most = 0;
  for (std::size_t k = 0; k + 1 < actuator.harmonics.size(); k += 2)
    most = std::max(most, std::hypot(actuator.harmonics[k], actuator.harmonics[k + 1]));
  return most;
}

bool controls(const Machine& machine, Component component) {
  const auto& list = machine.controlled;
  return std::find(list.begin(), list.end(), component) != list.end();
}

bool controls_pose(const Machine& machine) {
  for (const Component c :
       {Component::x, Component::y, Component::z, Component::rx, Component::ry, Component::rz})
    if (!controls(machine, c)) return false;
  return true;
}

Machine perfect(const Machine& machine) {
  Machine result = machine;
  for (Chain& chain : result.chains) make_perfect(chain.elements);
  return result;
}

double total_mass(const Branch& branch) {
  double kg = 0;
  for_each_element(branch.elements, [&](const Element& element) {
    if (const auto* mass = std::get_if<PointMass>(&element)) kg += mass->kg;
  });
  return kg;
}

double total_mass(const Machine& machine) {
  double kg = 0;
  for (const Chain& chain : machine.chains) kg += total_mass(chain);
  return kg;
}

bool weighs(const Machine& machine) {
  const auto has_mass = [](const auto& entry) { return entry.second.mass.has_value(); };
  return !machine.gravity.g.isZero(0) &&
         (total_mass(machine) > 0 || std::any_of(machine.tools.begin(), machine.tools.end(), has_mass));
}

std::vector<Actuator> actuators(const Machine& machine) {
  std::vector<Actuator> found;
  for (const Chain& chain : machine.chains) collect(chain.elements, found);
  return found;
}

bool turns_joints(const Machine& machine) {
  const std::vector<Actuator> all = actuators(machine);
  return std::any_of(all.begin(), all.end(),
                     [](const Actuator& actuator) { return actuator.joint.kind == JointKind::revolute; });
}

}  // namespace counterflex
