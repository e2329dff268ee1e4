#pragma once
/// The machine at the commanded states of all measurements.
#include <map>
#include <vector>

#include "counterflex/identify/measurements.hpp"
#include "counterflex/statics/parameter_tangents.hpp"

namespace counterflex {

/// The commanded states of all rows, one behind the other, at nominal configurations. They do not depend on
/// the parameters: the control computes with the nominal machine.
struct States {
  std::vector<std::size_t> first;  ///< by row: its first state
  std::vector<const CommandedState*> state;
  std::vector<Configuration> nominal;
  std::vector<Pose> X_MT;  ///< nominal tips
};

/// Models of the machine with each of the tools that states have in the spindle, 0 for that of [tool].
std::map<long, Model> models_of(const Machine& machine, const States& states);

/// Throws `InputError` at the first row whose state the nominal machine cannot reach. Keeps pointers into
/// `measurements`.
States nominal_states(const Machine& machine, const Measurements& measurements, int threads);

/// The tip at one state, and its tangents by the varied parameters.
struct Response {
  Status status = Status::not_converged;
  Pose X_MT;
  Eigen::Matrix<double, 6, Eigen::Dynamic> tangents;
  /// Of a clamped state: how far the torque turns its actuator (rad), and the tangents of that by
  /// compliances.
  double turn = 0;
  Eigen::RowVectorXd turn_tangents;
};

/// By state. `loaded` are the equilibria found before, empty at first; they are starts, and are replaced.
std::vector<Response> responses(const Machine& machine, const std::vector<std::size_t>& varied,
                                const States& states, int threads, std::vector<Configuration>& loaded);

}  // namespace counterflex
