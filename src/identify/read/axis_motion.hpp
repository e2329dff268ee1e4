#pragma once
/// Single axes of a machine, as measurements name them.
#include <optional>
#include <string_view>

#include "counterflex/identify/measurements.hpp"

namespace counterflex::measurement_file {

/// The axes of one machine. Keeps a reference to it.
class Axes {
 public:
  explicit Axes(const Machine& machine);

  /// By the control's name, "X" or "A1", or by number, "q3".
  std::optional<std::size_t> find(std::string_view text) const;

  bool turns(std::size_t axis) const { return actuators_[axis].joint.kind == JointKind::revolute; }
  const Actuator& actuator(std::size_t axis) const { return actuators_[axis]; }
  const std::string& name(std::size_t axis) const { return names_[axis]; }
  std::size_t count() const { return actuators_.size(); }

  /// The directions of joints whose shown values move by `signs` (-1, 0, 1; by actuator).
  Directions directions_of(const Eigen::VectorXd& signs) const;

  /// Those of the way from shown values to others. Joints that stay keep those of `before`.
  Directions directions_between(const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                                const Directions& before) const;

  /// The nominal tip at shown values. Empty where the machine cannot be there.
  std::optional<Pose> tip_at(const Eigen::VectorXd& shown) const;

  /// The unit vector (axes of M) along which the nominal tip moves with a linear axis at shown values, or
  /// about which it turns with a rotary one, for a growing shown value. Empty where the machine cannot be
  /// there, or the tip does not move as far as the axis: the axis of a leg, one that is coupled.
  std::optional<Vector3> direction_of(std::size_t axis, const Eigen::VectorXd& shown) const;

 private:
  std::vector<Actuator> actuators_;
  std::vector<std::string> names_;
  Model model_;
};

}  // namespace counterflex::measurement_file
