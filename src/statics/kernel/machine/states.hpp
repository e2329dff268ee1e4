#pragma once
/// Between configurations and the kernel's numbers.
#include "statics/kernel/machine/flatten.hpp"

namespace counterflex::kernel {

/// A pose as twelve numbers: R row by row, then p (m).
Pose get_pose(const double* numbers);

/// A state of the kernel as numbers. Wrenches are in N and N m, axes of M.
struct StateNumbers {
  std::vector<double> state;    ///< FlatMachine::state_size numbers
  std::vector<double> nominal;  ///< by joint: x_nominal
  std::vector<double> stress;   ///< by element: force and moment about its end; of groups zero
  std::vector<double> ends;     ///< by series: wrench on its end, about the tip that is wanted
};

/// The actuator that a joint is; -1: a free joint.
int actuator_of(const FlatMachine& machine, int joint);

/// State and stress of a configuration in a stage. Where frames at the two ends of an element do not fit to
/// its deflection, the last spring of its series takes the difference. The stress is what the wrench on the
/// end of a series makes in its springs; weights inside it are left out.
void read_state(const Mechanism& mechanism, const Flat& flat, const Configuration& configuration,
                const Stage& stage, StateNumbers& numbers);

/// The configuration of state and ends, about the point `p` of M. x_nominal stays as it is.
void write_state(const Mechanism& mechanism, const Flat& flat, const StateNumbers& numbers, const Vector3& p,
                 const Stage& stage, Configuration& configuration);

/// The nominal configuration with the state at `state`, of the machine that `flatten_rigid` makes. `like`:
/// one of the same machine.
Configuration nominal_of(const Mechanism& mechanism, const Flat& rigid, const double* state,
                         Configuration like);

}  // namespace counterflex::kernel
