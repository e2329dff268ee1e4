#pragma once
/// One waypoint in doubles, from any start and with any share of what acts: what the continuation asks.
/// EQUATIONS.md, section 8.
#include <memory>
#include <optional>

#include "statics/kernel/machine/states.hpp"
#include "statics/model/problem.hpp"

namespace counterflex::kernel {

using Waypoint = counterflex::Problem;

struct SingleAnswer {
  bool accepted = false;
  int iterations = 0;
  Pose first_X_MP;            ///< platform and actuators behind the first step
  Eigen::VectorXd first_rho;  ///< (m, rad)
};

/// The pivots of a tangent, actuators held (N/m; of rotations over l^2). Those above 1e9 N/m count as 1e9
/// N/m.
struct PivotRange {
  double least = 0, largest = 0;
  int unstable_directions = 0;
};

/// The kernel for one machine, with memory for one waypoint at a time.
class Single {
 public:
  explicit Single(const Mechanism& mechanism);
  ~Single();
  Single(Single&&) noexcept;

  /// Newton's method from `configuration`, which becomes the solution if it is accepted. Also not accepted
  /// are machines that the kernel does not take, and targets of machines that control nothing.
  SingleAnswer solve(const Mechanism& mechanism, const Waypoint& waypoint, Configuration& configuration);

  /// Of the tangent at an equilibrium. None where the kernel does not take the machine, or where its tangent
  /// leaves out too much of how weights turn with joints.
  std::optional<PivotRange> pivots(const Mechanism& mechanism, const Waypoint& waypoint,
                                   const Configuration& configuration);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace counterflex::kernel
