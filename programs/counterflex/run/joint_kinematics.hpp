#pragma once
/// Where a robot's control takes the tool to be at joint values.
#include "counterflex/machine/machine.hpp"
#include "counterflex/program/read_program.hpp"

namespace counterflex::cli {

/// Nominal forward kinematics of a machine whose actuators are six joints, besides those that the program
/// commands. A place is not known in a work offset that the machine does not have or that was touched off.
/// The result has a copy of the machine.
JointKinematics joint_kinematics(const Machine& machine);

}  // namespace counterflex::cli
