#pragma once
/// A machine in words, for an engineer who wants to know what was understood of a machine file.
#include <string>
#include <vector>

#include "counterflex/machine/machine.hpp"

namespace counterflex {

/// How many coordinates of each kind a chain has, branches of groups included.
struct Freedoms {
  int actuators = 0;
  int passives = 0;  ///< sprung ones too
  int elastic = 0;   ///< six a spring, one a compliance
};

Freedoms freedoms(const Chain& chain);

/// A page of text, lines ended by "\n": settings, chains with one element a line, springs, actuators with
/// their travel, assembly errors. Lengths in mm, angles in degrees, stiffness in N/m and N m/rad.
std::string describe(const Machine& machine);

/// What is unusual, but not wrong, as far as the data show it (no kinematics is solved); one sentence each.
std::vector<std::string> structural_notes(const Machine& machine);

}  // namespace counterflex
