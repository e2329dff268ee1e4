#pragma once
/// What the control corrects by itself.
#include "counterflex/machine/machine.hpp"

namespace counterflex {

/// Takes what `already_corrects` names out of the machine.
void leave_out_corrected(Machine& machine);

}  // namespace counterflex
