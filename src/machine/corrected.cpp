#include "machine/corrected.hpp"

#include <algorithm>

namespace counterflex {
namespace {

template <class Change>
void for_each_actuator(std::vector<Element>& elements, const Change& change) {
  for (Element& element : elements) {
    if (auto* actuator = std::get_if<Actuator>(&element)) change(*actuator);
    if (auto* group = std::get_if<Group>(&element))
      for (Branch& branch : group->branches) for_each_actuator(branch.elements, change);
  }
}

}  // namespace

void leave_out_corrected(Machine& machine) {
  const auto corrects = [&](Corrected what) {
    return std::ranges::find(machine.already_corrects, what) != machine.already_corrects.end();
  };
  if (corrects(Corrected::gravity)) machine.gravity.g.setZero();  // preloads still act on the zero at home
  for (Chain& chain : machine.chains)
    for_each_actuator(chain.elements, [&](Actuator& actuator) {
      if (corrects(Corrected::error_tables)) actuator.errors.reset(), actuator.harmonics.clear();
      if (corrects(Corrected::reversal)) actuator.reversal.reset();
    });
}

}  // namespace counterflex
