#pragma once
/// How the tip of a loaded machine moves with the machine's parameters (machine/parameters.hpp), its
/// actuators held. EQUATIONS.md, section 12.
#include <memory>
#include <vector>

#include "counterflex/machine/parameters.hpp"
#include "counterflex/statics/equilibrium.hpp"

namespace counterflex {

/// Tangents of one machine with respect to some of its parameters. Keeps a reference to nothing; threads may
/// share it.
class ParameterTangents {
 public:
  /// `varied`: indices into `parameters(machine)`. `model` is that of `machine`, or of the machine with a
  /// tool of [tools]. A zero that was set under weight is that of `machine` itself. `and_load`: the size of
  /// the load is varied, too, behind the parameters.
  ParameterTangents(const Machine& machine, const Model& model, const std::vector<std::size_t>& varied,
                    bool and_load = false, const Tool* tool = nullptr);
  ~ParameterTangents();
  ParameterTangents(ParameterTangents&&) noexcept;

  /// Memory for one thread.
  StaticsWork work() const;

  /// Twist of the tip (m, rad; axes of M) by parameter (SI): 6 x as many as are varied. `configuration` is an
  /// equilibrium of the model under `load`, all of whose errors, preloads and weights act; `work` is one of
  /// `work()`. Of a reversal: for motion in the positive direction; the other way it has the other sign. Of
  /// the load's size: the twist by which the tip would move if all of the load came once more.
  Eigen::Matrix<double, 6, Eigen::Dynamic> of_tip(const Configuration& configuration, const Load& load,
                                                  StaticsWork& work) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace counterflex
