#pragma once
/// Machines with tables of errors on all actuators.
#include "statics/support/laws_support.hpp"

namespace counterflex::laws {

/// Positions from -1.2 to 1.2 m or rad, unevenly about 0.05 apart; errors up to `size` times 1 mm and 5 mrad.
inline ErrorTable random_table(Random& random, double size) {
  ErrorTable table{"random"};
  for (double at = -1.2; at < 1.2; at += 0.05 + 0.03 * random.number()) {
    table.positions.push_back(at);
    table.errors.push_back(random.six(1e-3 * size, 5e-3 * size));
  }
  return table;
}

inline void add_tables(std::vector<Element>& elements, double size, Random& random) {
  for (Element& element : elements) {
    if (auto* actuator = std::get_if<Actuator>(&element)) actuator->errors = random_table(random, size);
    if (auto* group = std::get_if<Group>(&element))
      for (Branch& branch : group->branches) add_tables(branch.elements, size, random);
  }
}

inline Machine with_tables(Machine machine, double size, unsigned seed = 9) {
  Random random(seed);
  for (Chain& chain : machine.chains) add_tables(chain.elements, size, random);
  return machine;
}

}  // namespace counterflex::laws
