#include "counterflex/machine/create.hpp"

#include "machine/create/words.hpp"

namespace counterflex {

std::string machine_file(const MachineFacts& facts) {
  switch (facts.kind) {
    case MachineKind::robot6r:
      return made::robot_file(facts);
    case MachineKind::hexapod:
      return made::hexapod_file(facts);
    case MachineKind::delta:
      return made::delta_file(facts);
    case MachineKind::orthoglide:
      return made::orthoglide_file(facts);
    default:
      return made::mill_file(facts);
  }
}

}  // namespace counterflex
